// The observer of a cast: which nodes rays sample, and how much too coarse these are.

fn note(node: u32, deficit: f32) {
    let code = u32(32768.0 + ceil(clamp(deficit, -100.0, 100.0) * 256.0));
    atomicMax(&feedback[node].deficit_code, code);
    atomicAdd(&feedback[node].rays, 1u);
}
