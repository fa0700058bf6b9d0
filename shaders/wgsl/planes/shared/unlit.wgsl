// No light falls on means.

fn keep_cell_gradient(at: u32, gradients: Gradients) {
}

fn body_of(gradients: Gradients, ray: Ray) -> f32 {
    return 1.0;
}

fn highlight_between(at: u32, part: f32, ray: Ray) -> f32 {
    return 0.0;
}
