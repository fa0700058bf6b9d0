//! Numbers at the ends of single precision.

use super::layers::{PROJECTORS, display, scene, volume};
use glam::DVec3;
use lightloom_tests::closure_volume::bumps;
use lightloom_tests::draw::{self, With, draw};
use optics::{BandPicker, Enhancer, LayerOpacity, Ramp, Trapezoid};
use protocol::ProjectorImage;

fn what_is_no_light(images: &[ProjectorImage]) -> usize {
    images.iter().flat_map(|image| &image.rgba).filter(|n| !(n.is_finite() && **n >= 0.0)).count()
}

#[test]
fn numbers_that_f32_cannot_hold_are_refused_or_are_light() {
    let _turn = draw::turn();
    let display = display();
    let source = volume(bumps);
    let axis_in_display = DVec3::NEG_Z;
    let band = Trapezoid::new([0.4, 0.5, 0.6, 0.7]).unwrap();
    // In f32 both limits are 1, which the middle pixel meets.
    let facing = Ramp { low: 0.999_999_99, high: 1.0 };
    let endless = Trapezoid::new([-1e39, 0.5, 0.6, 0.7]).unwrap();
    let steep = Enhancer::BandPicker(BandPicker { band, axis_in_display, facing, strength: 1.0 });
    let links = [Enhancer::LayerOpacity(LayerOpacity {
        band: endless,
        axis_in_display,
        facing: Ramp { low: 0.0, high: 0.5 },
        away: 1.0,
        toward: 0.1,
    })];
    let mut failed = Vec::new();
    for link in links {
        let mut frame = scene(&display, &source, 0.0);
        frame.eta = 0.0;
        frame.optics.enhancers = vec![link];
        assert_eq!(frame.optics.check(), Ok(()));
        let mut refused = frame.clone();
        refused.optics.enhancers = vec![steep];
        assert!(refused.optics.check().is_err());
        for device in draw::devices() {
            let images = draw(&display, &frame, &source, &PROJECTORS, With::device(device)).images;
            if what_is_no_light(&images) > 0 {
                failed.push(format!("{device:?}, {link:?}: {} numbers", what_is_no_light(&images)));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
