//! Tools that are held away from the volume change nothing of its picture, and are not in its kernel.

use display_config::Display;
use glam::DVec3;
use lightloom_tests::draw::{self, With};
use lightloom_tests::scenes::{self};
use optics::{ClipPlane, Enhancer, Probe, Ramp};
use protocol::FrameState;

const FACING: Ramp = Ramp { low: 0.2, high: 0.8 };

fn tools(away_m: f64) -> Vec<Enhancer> {
    let plane = ClipPlane {
        point_in_display: DVec3::new(0.0, 0.0, away_m),
        normal_in_display: DVec3::Z,
        context: FACING,
        thickness_m: 0.01,
        boost: 2.0,
        strength: 1.0,
    };
    let probe = Probe {
        centre_in_display: DVec3::new(away_m, 0.0, 0.0),
        radius_m: 0.1,
        axis_in_display: DVec3::NEG_Z,
        facing: FACING,
        gradient_most: 0.1,
        edges: FACING,
        strength: 1.0,
    };
    vec![Enhancer::Probe(probe), Enhancer::ClipPlane(plane)]
}

#[test]
fn tools_away_from_the_volume_change_nothing() {
    let _turn = draw::turn();
    let display = Display::load("desk8").expect("a preset").with_rasters(40, 30);
    let scene = scenes::shells(&display);
    for device in draw::devices() {
        let picture = |frame: &FrameState| {
            draw::draw(&display, frame, &scene.source, &[3], With::device(device)).images
        };
        let with = |away_m: f64, which: usize| {
            let mut frame = scene.frame.clone();
            frame.optics.enhancers = vec![tools(away_m)[which]];
            picture(&frame)
        };
        let plain = picture(&scene.frame);
        for which in [0, 1] {
            assert!(with(3.0, which) == plain, "tool {which} acts from afar on {device:?}");
            // The canary: held into the volume it does something.
            assert!(with(0.0, which) != plain, "tool {which} does nothing on {device:?}");
        }
    }
}
