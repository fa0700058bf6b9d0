// The observer of a cast: which nodes rays sample, and how much too coarse these are.

fn note(node: u32, deficit: f32) {
    let code = u32(CODE_OF_ZERO + ceil(clamp(deficit, -MOST_DEFICIT, MOST_DEFICIT) * CODES_PER_LEVEL));
    atomicMax(&feedback[node].deficit_code, code);
    atomicAdd(&feedback[node].rays, 1u);
}
