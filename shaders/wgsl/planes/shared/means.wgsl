// Means of what lies between two layers, column by column: all views share them.

@compute @workgroup_size(PLANE_COLUMNS, 1, 1)
fn find_means(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let place = plane_place(group);
    let column = place.first + lane;
    if !place.exists || place.layer.has_cell == 0u || column >= place.layer.width {
        return;
    }
    let at = kept_at(place, column);
    let behind = at + place.layer.width;
    let s0 = known_scalar(at);
    let s1 = known_scalar(behind);
    var mean = vec4<f32>(0.0);
    var gradients = NO_GRADIENTS;
    if min(s0, s1) >= 0.0 {
        let spread = 0.5 * (known_spread(at) + known_spread(behind));
        if !is_vacant_around(vec2<f32>(min(s0, s1), max(s0, s1)), spread) {
            let k = sample_over(locate(s0), locate(s1), s0, s1, spread).k * thickness_of(place.layer);
            gradients = gradients_between(known_gradients(at), known_gradients(behind), 0.5);
            let ray = line_of(row_of(place.band, place.number), place.layer.z.x);
            mean = vec4<f32>(k.xyz * body_of(gradients, ray), k.w);
        }
    }
    keep_mean(at, mean);
    keep_cell_gradient(at, gradients);
}
