// One ray per invocation that ends before what lies behind something.

@compute @workgroup_size(SHORT_RAYS, 1, 1)
fn cast_short(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>) {
    let listed = (group.x + group.y * groups.x) * SHORT_RAYS + local.x;
    if listed >= projector.raster.w {
        return;
    }
    // Its pixel, row by row, and its end.
    let pixel = tiles[2u * listed];
    let place = vec2<u32>(pixel % projector.raster.x, pixel / projector.raster.x);
    var ray = ray_of_pixel(vec2<f32>(place) + 0.5);
    ray.end = bitcast<f32>(tiles[2u * listed + 1u]);
    var count = 0u;
    pixels[listed] = cast_ray(ray, &count);
    counts[listed] = count;
}
