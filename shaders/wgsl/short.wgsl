// One ray per invocation that ends before what lies behind something.

@compute @workgroup_size(SHORT_RAYS, 1, 1)
fn cast_short(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>) {
    let place = (group.x + group.y * groups.x) * SHORT_RAYS + local.x;
    if place >= listed[0] {
        return;
    }
    projector = views[listed[1u + 3u * place]];
    // Its pixel, row by row, and its end.
    let pixel = listed[2u + 3u * place];
    var ray = ray_of_pixel(vec2<f32>(vec2<u32>(pixel % projector.raster.x, pixel / projector.raster.x)) + 0.5);
    ray.end = bitcast<f32>(listed[3u + 3u * place]);
    var count = 0u;
    pixels[place] = cast_ray(ray, &count);
    counts[place] = count;
}
