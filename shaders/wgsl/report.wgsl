// What rays report of the nodes that they sample.

fn report(at: u32, deficit: f32) {
    let code = u32(32768.0 + ceil(clamp(deficit, -100.0, 100.0) * 256.0));
    atomicMax(&feedback[at].deficit_code, code);
    atomicAdd(&feedback[at].rays, 1u);
}
