//! The illustrative techniques that a gallery shows.

use super::Subject;
use glam::DVec3;
use optics::{BandPicker, ClipPlane, Detail, Enhancer, LayerOpacity, Mimda, MimdaForm, Probe, Ramp};
use protocol::FrameState;

/// One technique.
pub struct Technique {
    /// Its name.
    pub name: &'static str,
    /// What it does, and what to look for.
    pub about: &'static str,
    /// The frame without it.
    pub off: fn(&Subject) -> FrameState,
    /// Turns it on in that frame.
    pub turn_on: fn(&Subject, &mut FrameState),
}

impl Technique {
    /// What the files of its pictures begin with: without it, and with it.
    pub(super) fn shots(&self) -> [String; 2] {
        let slug = self.name.to_lowercase().replace(' ', "-").replace(',', "");
        ["off", "on"].map(|state| format!("{slug}-{state}"))
    }
}

/// All of them, in the order of the page.
pub const TECHNIQUES: [Technique; 13] = [
    Technique {
        name: "Quadrilinear filtering",
        about: "Samples are filtered over a node, its parent and its grandparent, by the display's resolution at their \
                depth: no seam shows where the level of detail changes, and nothing is finer than the display can show.",
        off: |subject| subject.frame.clone(),
        turn_on: |_, frame| frame.quality.quadrilinear = true,
    },
    Technique {
        name: "Gradient shading",
        about: "Boundaries are shaded by the gradient of the scalar, which gives shape to plain colour.",
        off: |subject| FrameState { light: None, ..subject.frame.clone() },
        turn_on: |subject, frame| frame.light = Some(subject.light),
    },
    Technique {
        name: "Shading per material",
        about: "Each tissue reflects light in its own way instead of all alike: matt outside, glossy inside.",
        off: |subject| subject.frame.clone(),
        turn_on: |subject, frame| frame.optics.materials = Some(subject.materials.clone()),
    },
    Technique {
        name: "Unsharp masking of normals",
        about: "Gradients are sharpened by their difference from the next coarser level, so creases and small bumps \
                stand out.",
        off: Subject::inner_alone,
        turn_on: |_, frame| set_detail(frame, Detail::Unsharp { strength: 1.5 }),
    },
    Technique {
        name: "Exaggerated shading",
        about: "Each level is lit at a grazing angle of its own, so relief shows at all scales under any light.",
        off: Subject::inner_alone,
        turn_on: |_, frame| set_detail(frame, Detail::Exaggerated { contrast: 3.0 }),
    },
    Technique {
        name: "Refraction",
        about: "Rays bend where the refraction index changes: things inside a glassy skin look as if seen through glass.",
        off: Subject::glassy,
        turn_on: |subject, frame| frame.optics.refraction = Some(subject.refraction.clone()),
    },
    Technique {
        name: "Importance accumulation as published",
        about: "Important things show through whatever lies in front of them (MImDA). In the published form, a gentle rise \
                of importance leaves some of the cover.",
        off: Subject::covered,
        turn_on: |subject, frame| accumulate(subject, frame, MimdaForm::Paper),
    },
    Technique {
        name: "Importance accumulation, consistent",
        about: "The same in the form whose picture does not depend on the step length: a rise of importance clears the \
                cover, however gentle it is.",
        off: Subject::covered,
        turn_on: |subject, frame| accumulate(subject, frame, MimdaForm::Consistent),
    },
    Technique {
        name: "Clip plane with context",
        about: "A plane faces the left eye and cuts away everything in front of it. To the right eye, which looks along the \
                plane, the part that was cut away comes back as context.",
        off: Subject::covered,
        turn_on: |subject, frame| frame.optics.enhancers = vec![cut_for_left_eye(subject)],
    },
    Technique {
        name: "Context-preserving probe",
        about: "A sphere opens to the left eye, which looks along its axis, and keeps the edges inside it. From the right \
                it is empty.",
        off: Subject::covered,
        turn_on: |subject, frame| {
            let toward_eye = -subject.look_of(0) * 0.18 * subject.depth_m;
            frame.optics.enhancers = vec![probe(subject, subject.centre + toward_eye)];
        },
    },
    Technique {
        name: "Band picker",
        about: "A viewer looking along the tool, here the left eye, sees the picked band alone; the others see everything.",
        off: Subject::covered,
        turn_on: |subject, frame| frame.optics.enhancers = vec![picker(subject)],
    },
    Technique {
        name: "Layer opacity",
        about: "The outer layer thins out toward one direction of view, here the left eye's.",
        off: Subject::covered,
        turn_on: |subject, frame| frame.optics.enhancers = vec![thin_layer(subject, 0)],
    },
    Technique {
        name: "A chain of three",
        about: "A slanted cut through the upper front for all eyes, a probe below it for the left eye, and a layer that \
                thins out for the right one.",
        off: Subject::covered,
        turn_on: |subject, frame| {
            let below = DVec3::new(0.0, -0.15 * subject.longest_m, 0.2 * subject.depth_m);
            let probe = probe(subject, subject.centre + below);
            frame.optics.enhancers = vec![slanted_cut(subject), probe, thin_layer(subject, 2)];
        },
    },
];

fn set_detail(frame: &mut FrameState, detail: Detail) {
    if let Some(light) = &mut frame.light {
        light.detail = detail;
    }
}

fn accumulate(subject: &Subject, frame: &mut FrameState, form: MimdaForm) {
    frame.optics.mimda = Some(Mimda { importance: subject.importance.clone(), gamma: 0.95, form });
}

fn cut_for_left_eye(subject: &Subject) -> Enhancer {
    let facing = subject.facing();
    Enhancer::ClipPlane(ClipPlane {
        point_in_display: subject.centre,
        normal_in_display: -subject.look_of(0),
        context: Ramp { low: 1.0 - facing.high, high: 1.0 - facing.low },
        thickness_m: 0.02 * subject.longest_m,
        boost: ClipPlane::OPAQUE,
        strength: 1.0,
    })
}

/// Cuts the upper front away for everyone: its context begins beyond all viewers in front of the screen.
fn slanted_cut(subject: &Subject) -> Enhancer {
    let normal = DVec3::new(0.0, 1.0, 1.0).normalize();
    Enhancer::ClipPlane(ClipPlane {
        point_in_display: subject.centre + normal * 0.2 * subject.longest_m,
        normal_in_display: normal,
        context: Ramp { low: 0.6, high: 0.95 },
        thickness_m: 0.02 * subject.longest_m,
        boost: ClipPlane::OPAQUE,
        strength: 1.0,
    })
}

fn probe(subject: &Subject, centre_in_display: DVec3) -> Enhancer {
    Enhancer::Probe(Probe {
        centre_in_display,
        radius_m: 0.32 * subject.longest_m,
        axis_in_display: subject.look_of(0),
        facing: subject.facing(),
        gradient_most: 0.1,
        edges: Ramp { low: 0.2, high: 0.8 },
        strength: 1.0,
    })
}

fn picker(subject: &Subject) -> Enhancer {
    Enhancer::BandPicker(BandPicker {
        band: subject.inner,
        axis_in_display: subject.look_of(0),
        facing: subject.facing(),
        strength: 1.0,
    })
}

fn thin_layer(subject: &Subject, eye: usize) -> Enhancer {
    Enhancer::LayerOpacity(LayerOpacity {
        band: subject.outer,
        axis_in_display: subject.look_of(eye),
        facing: subject.facing(),
        away: 1.0,
        toward: 0.05,
    })
}
