// No light falls: no gradient is kept.

const GRADIENT_WORDS: u32 = 0u;

fn keep_gradient(at: u32, brick: Brick, ray: Ray) {
}

fn cell_gradient(front: u32, behind: u32) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn keep_cell_gradient(at: u32, gradient: vec3<f32>) {
}

fn body_of(gradient: vec3<f32>, ray: Ray) -> f32 {
    return 1.0;
}

fn highlight_between(at: u32, part: f32, ray: Ray) -> f32 {
    return 0.0;
}
