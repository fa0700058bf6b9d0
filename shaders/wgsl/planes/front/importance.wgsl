// What pixels have gathered when a sweep begins is in their picture, but for the largest importance so far.

@group(0) @binding(BINDING_MOST_IMPORTANT) var<storage, read_write> most_important: array<f32>;

fn front_at(index: u32, place: u32) -> Accumulated {
    let known = pixels[index];
    return Accumulated(known.xyz, known.w, most_important[place]);
}

fn keep_front(index: u32, place: u32, front: Accumulated) {
    pixels[index] = vec4<f32>(front.rgb, front.alpha);
    most_important[place] = front.importance;
}
