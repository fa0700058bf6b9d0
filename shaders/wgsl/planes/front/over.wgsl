// What pixels have gathered when a sweep begins is in their picture.

fn front_at(index: u32, place: u32) -> Accumulated {
    let known = pixels[index];
    return Accumulated(known.xyz, known.w);
}

fn keep_front(index: u32, place: u32, front: Accumulated) {
    pixels[index] = vec4<f32>(front.rgb, front.alpha);
}
