//! Hard cases by row planes: pictures of light, and as near to the reference as each case allows.

use crate::hard_cases::{self, Case, PROJECTORS, as_met, assert_is_light, half_dark};
use lightloom_tests::compare::{Limits, errors, truth};
use lightloom_tests::draw::{self, With};
use lightloom_tests::results::{Program, Results};
use protocol::{Caster, ProjectorImage};

/// What planes keep in hard cases, as of what they cast otherwise: a fifth above the most that was measured. Those that they do
/// not keep it in have limits of their own.
const PROMISE: Limits = Limits::of_255(0.52, 9.3, 15.0);

fn limits_of(name: &str) -> Limits {
    match name {
        // Opaque skins a hundredth of a voxel thick and thinner, of which few samples a voxel are taken: where the scalar turns
        // between two of them a pixel shows the skin or what lies behind. 255 is all that a pixel can err; the RMS allows one.
        "a spike of 1 per voxel" => Limits::of_255(0.11, 3.0, 5.2),
        "a spike of 1e3 per voxel" => Limits::of_255(2.2, 1.4, 256.0),
        "a spike of 1e6 per voxel" => Limits::of_255(2.4, 1.5, 256.0),
        "a narrow spike of 1e2 per voxel" => Limits::of_255(0.36, 2.6, 58.0),
        "a narrow spike of 1e4 per voxel" => Limits::of_255(1.1, 2.8, 203.0),
        "up to 1e4 per voxel" => Limits::of_255(0.28, 4.8, 19.1),
        // On the outline of the jump, and where the scalar turns just below the peak, a pixel loses what lies before it or nothing.
        "importance that jumps" => Limits::of_255(0.8, 0.7, 149.0),
        "importance that jumps, gamma 1" => Limits::of_255(1.0, 0.7, 187.0),
        "importance that rises to 1, gamma 1" => Limits::of_255(0.65, 6.0, 117.0),
        _ => PROMISE,
    }
}

/// Cases whose volume reaches to where beams cross, and projectors that are not behind the screen: rays cast these.
const REFUSED: [&str; 3] =
    ["a viewer 10 km away", "camera on the front face", "projectors in the viewer's plane"];

/// The pictures, or why there are none.
fn drawn(case: &Case) -> Result<Vec<ProjectorImage>, String> {
    let with = With { filter: case.filter, ..With::PLANES };
    let (mut renderer, _) = draw::renderer(&case.display, &case.source, &PROJECTORS, with);
    let (images, report) =
        draw::try_draw_with(&mut renderer, &case.frame).map_err(|error| error.to_string())?;
    assert!(matches!(report.caster, Caster::Planes { .. }), "{:?}", report.caster);
    Ok(images)
}

#[test]
fn planes_cast_hard_cases() {
    let _turn = draw::turn();
    let (mut failed, mut refused) = (Vec::new(), Vec::new());
    let mut results = Results::new(Program::Tests("accuracy"), "accuracy", "hard cases by row planes");
    results.line("| case | pixels lit | RMS, 99.9 %, largest error of 255 |");
    results.line("| --- | ---: | ---: |");
    for mut case in hard_cases::all() {
        // Planes cast no rays that all come from the viewer: those of the display's own parallax then.
        if case.frame.eta == 0.0 {
            case.frame.eta = 1.0;
        }
        let images = match drawn(&case) {
            Ok(images) => images,
            Err(why) => {
                results.line(format!("| {} | | {why} |", case.name));
                refused.push(case.name);
                continue;
            }
        };
        assert_is_light(&case.name, &images);
        let truth = truth(&case.display, &case.frame, &case.source, &PROJECTORS, 1);
        let truth = if case.may_middle_miss { as_met(&images, &truth) } else { truth };
        let (found, limits) = (errors(&images, &truth), limits_of(&case.name));
        let [rms, p999, max] = [found.rms, found.p999, found.max].map(|error| 255.0 * error);
        results.line(format!("| {} | {} | {rms:.3}, {p999:.2}, {max:.2} |", case.name, found.lit));
        if !limits.hold(&found) {
            failed.push(format!("{}: {found}", case.name));
        }
        // The canary: half of the columns dark.
        if found.lit > 500 && limits.hold(&errors(&half_dark(&images), &truth)) {
            failed.push(format!("{}: half a picture passes", case.name));
        }
    }
    results.finish().unwrap();
    assert_eq!(refused, REFUSED);
    assert!(failed.is_empty(), "{failed:#?}");
}
