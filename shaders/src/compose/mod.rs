//! Kernels composed for what a scene uses: WGSL modules concatenated, one per slot.
//!
//! | slot | modules |
//! | --- | --- |
//! | rays | `listed` and `cast`, or `short`, or a step of row planes: `planes/fill`, `means`, `errors` or `sweep` |
//! | filter | `sample/hardware`, or `gathered` or `exact` with `quads` |
//! | look-up | `place/listed`, `place/halved` |
//! | levels | `levels/one`, `levels/two`, `levels/three` |
//! | weights | `levels/no_weights`, `levels/weights` |
//! | spread | `spread/none`, or `spread/level` with `one`, `two` or `three` |
//! | gradient | `gradient/none`, `own`, `toward_parent`, `blended`, `detail` |
//! | material | `material/one`, `table` |
//! | shade | `shade/plain`, `phong`, `unsharp`, `exaggerated` |
//! | composite | `composite/plain_sample` or `sample`; `over`, or `mimda` with `mimda_paper` or `mimda_consistent` |
//! | enhance | `enhance/none`, or up to eight of the enhancers and the glue of a [`needs::Chain`] |
//! | way | `way/straight`, or `way/path`, `pair` and `refracted` |
//! | debug | `debug/none`, `node`, `samples`, see [`optics::DebugView`] |
//!
//! What is shown of a picture is made by kernels of their own, without slots: [`PresentKernel`]. So is
//! what the rays of each tile counted: [`tally_wgsl`]. Windows are painted with [`paint_wgsl`].

mod chain;
mod constants;
mod debug_view;
mod kernel;
mod paint;
mod present;
mod tally;

pub use kernel::{Filter, KernelKey, KernelRays, Lookup, PlaneStep};
pub use paint::{PAINT_CORNER, PAINT_PIXEL, paint_wgsl};
pub use present::PresentKernel;
pub use tally::{TALLY_ENTRY_POINT, tally_wgsl};
