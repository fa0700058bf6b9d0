//! The kernel of a debug view.

use optics::DebugView;

/// The modules of a kernel that shows it, and the numbers that they read.
pub(super) fn wgsl(view: DebugView) -> String {
    let (least, most) = view.scale();
    let (low, high) = view.colours();
    let (shows, module) = match view {
        DebugView::Lod => (0, include_str!("../../wgsl/debug/node.wgsl")),
        DebugView::Deficit => (1, include_str!("../../wgsl/debug/node.wgsl")),
        DebugView::Weights => (2, include_str!("../../wgsl/debug/node.wgsl")),
        DebugView::Samples => (3, include_str!("../../wgsl/debug/samples.wgsl")),
    };
    let numbers = [("LEAST", least), ("MOST", most), ("LOW", low), ("HIGH", high)];
    let numbers = numbers.map(|(name, value)| format!("const DEBUG_{name}: f32 = {value:?};\n")).concat();
    let ramp = |(i, [r, g, b]): (usize, [f64; 3])| {
        format!(
            "const HEAT_RAMP_{i}: vec3<f32> = vec3<f32>({:?}, {:?}, {:?});\n",
            r as f32, g as f32, b as f32
        )
    };
    let ramps: String = optics::heat_ramps().into_iter().enumerate().map(ramp).collect();
    let heat = include_str!("../../wgsl/debug/heat.wgsl");
    format!("const DEBUG_SHOWS: u32 = {shows}u;\n{numbers}{ramps}{heat}{module}")
}
