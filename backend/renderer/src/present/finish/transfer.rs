//! The transfer curve: the code for a light, by rounding or by dither.

use super::dither::threshold;
#[cfg(feature = "gpu")]
use crate::output::srgb_edges;
use crate::output::{srgb_codes, srgb_light};
use display_config::{Response, Transfer};

/// Entries of the table that guesses a code.
const GUESSES: usize = 4096;

/// A projector's curve, ready.
pub(super) enum Curve {
    /// The codes of pictures on any screen.
    Srgb,
    /// Red, green, blue.
    Rounded(Box<[Steps; 3]>),
    /// Red, green, blue.
    Dithered(Box<[Ramp; 3]>),
}

impl Curve {
    pub fn new(transfer: &Transfer, is_dithered: bool) -> Self {
        let lights = [0, 1, 2].map(|channel| LightOfCode::of(transfer, channel));
        match (transfer, is_dithered) {
            (Transfer::Srgb, false) => Self::Srgb,
            (_, false) => Self::Rounded(Box::new(lights.map(|light| Steps::rounding(&light)))),
            (_, true) => Self::Dithered(Box::new(lights.map(|light| Ramp::new(&light)))),
        }
    }

    /// The codes of no light, where they are the same at every pixel.
    pub fn of_black(&self) -> Option<[u8; 3]> {
        match self {
            Self::Dithered(_) => None,
            _ => Some(self.codes([0.0; 3], [0, 0])),
        }
    }

    /// The codes of the light of a pixel, from 0 to 1.
    pub fn codes(&self, light: [f32; 3], pixel: [usize; 2]) -> [u8; 3] {
        match self {
            Self::Srgb => srgb_codes(&light),
            Self::Rounded(steps) => std::array::from_fn(|c| steps[c].up_to(light[c])),
            Self::Dithered(ramps) => {
                let threshold = threshold(pixel);
                std::array::from_fn(|c| ramps[c].code(light[c], threshold))
            }
        }
    }
}

/// Beyond all light, where a kernel has no ∞.
#[cfg(feature = "gpu")]
const BEYOND: f32 = 1e30;

#[cfg(feature = "gpu")]
impl Curve {
    /// The curves of red, green and blue as a kernel reads them: of each the lights at which its code rises, then those of
    /// all codes, which only dither asks for.
    pub fn numbers(&self) -> Vec<f32> {
        let channel = |channel: usize| -> Vec<f32> {
            match self {
                Self::Srgb => [srgb_edges(), &[0.0; 256]].concat(),
                Self::Rounded(steps) => [&steps[channel].edges[..], &[0.0; 256]].concat(),
                Self::Dithered(ramps) => {
                    [&ramps[channel].steps.edges[..], &ramps[channel].lights[..]].concat()
                }
            }
        };
        (0..3).flat_map(channel).map(|light| light.clamp(-BEYOND, BEYOND)).collect()
    }

    /// Whether codes are dithered.
    pub fn is_dithered(&self) -> bool {
        matches!(self, Self::Dithered(_))
    }
}

/// The light that a channel makes of a code, also between whole codes.
enum LightOfCode<'a> {
    Srgb,
    Gamma(f64),
    Measured(&'a Response),
}

impl<'a> LightOfCode<'a> {
    fn of(transfer: &'a Transfer, channel: usize) -> Self {
        match transfer {
            Transfer::Srgb => Self::Srgb,
            Transfer::Gamma(gamma) => Self::Gamma(*gamma),
            Transfer::Measured(responses) => Self::Measured(&responses[channel]),
        }
    }

    /// Below the codes that were measured it is −∞, and beyond them ∞: no light asks for them.
    fn at(&self, code: f64) -> f64 {
        match self {
            Self::Srgb => srgb_light(code / 255.0),
            Self::Gamma(gamma) => (code / 255.0).powf(*gamma),
            Self::Measured(response) => measured(response.knots(), code),
        }
    }
}

fn measured(knots: &[(f64, u8)], code: f64) -> f64 {
    let beyond = knots.partition_point(|&(_, known)| f64::from(known) < code);
    match (beyond.checked_sub(1).map(|before| knots[before]), knots.get(beyond)) {
        (_, Some(&(light, known))) if f64::from(known) == code => light,
        (Some((low, from)), Some(&(high, to))) => {
            low + (high - low) * (code - f64::from(from)) / (f64::from(to) - f64::from(from))
        }
        (None, _) => f64::NEG_INFINITY,
        (_, None) => f64::INFINITY,
    }
}

/// Lights at which the code rises by one, and a table that guesses.
pub(super) struct Steps {
    /// The smallest light whose code is above i.
    edges: [f32; 255],
    /// The code at the low end of each of `GUESSES` equal parts of [0, 1].
    guess: Vec<u8>,
}

impl Steps {
    /// Half-way between codes.
    fn rounding(light: &LightOfCode<'_>) -> Self {
        Self::new(std::array::from_fn(|i| not_below(light.at(i as f64 + 0.5))))
    }

    fn new(edges: [f32; 255]) -> Self {
        let code = |x: f32| edges.partition_point(|edge| *edge <= x) as u8;
        let guess = (0..=GUESSES).map(|i| code(i as f32 / GUESSES as f32)).collect();
        Self { edges, guess }
    }

    /// As many edges as a light from 0 to 1 reaches.
    fn up_to(&self, light: f32) -> u8 {
        let mut code = self.guess[(light * GUESSES as f32) as usize];
        while self.edges.get(usize::from(code)).is_some_and(|edge| *edge <= light) {
            code += 1;
        }
        code
    }
}

/// The smallest f32 that is not below a number.
fn not_below(number: f64) -> f32 {
    let near = number as f32;
    if f64::from(near) < number { near.next_up() } else { near }
}

/// The lights of all codes, for light between two of them.
pub(super) struct Ramp {
    lights: [f32; 256],
    steps: Steps,
}

impl Ramp {
    fn new(light: &LightOfCode<'_>) -> Self {
        let lights: [f32; 256] = std::array::from_fn(|code| light.at(code as f64) as f32);
        // The lowest code is that of all light up to its own.
        let lowest = lights.iter().position(|light| light.is_finite()).unwrap_or(0);
        let edge = |i: usize| if i < lowest { f32::NEG_INFINITY } else { lights[i + 1] };
        Self { lights, steps: Steps::new(std::array::from_fn(edge)) }
    }

    /// One of the two codes around a light, the brighter one on as many pixels as keeps the mean of the light itself.
    fn code(&self, light: f32, threshold: f32) -> u8 {
        let below = self.steps.up_to(light);
        let Some(above) = self.lights.get(usize::from(below) + 1) else { return below };
        let low = self.lights[usize::from(below)];
        below + u8::from(light - low > threshold * (above - low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured_curve() -> Transfer {
        let response = |knots: &[(f64, u8)]| Response::new(knots.to_vec()).unwrap();
        let red = response(&[(0.0, 0), (1.0, 255)]);
        let green = response(&[(0.01, 4), (0.2, 100), (1.3, 240)]);
        Transfer::Measured(Box::new([red.clone(), green, red]))
    }

    #[test]
    fn a_measured_curve_is_inverted_exactly() {
        let Curve::Rounded(steps) = Curve::new(&measured_curve(), false) else { panic!("not rounded") };
        let code = |light: f64| {
            let inner = if light < 0.2 {
                4.0 + (light - 0.01) / 0.19 * 96.0
            } else {
                100.0 + (light - 0.2) / 1.1 * 140.0
            };
            inner.clamp(4.0, 240.0)
        };
        for i in 0..=20_000 {
            let light = i as f32 / 20_000.0;
            let (found, exact) = (steps[1].up_to(light), code(f64::from(light)));
            assert!((f64::from(found) - exact).abs() <= 0.5 + 1e-9, "{light}: {found}, {exact}");
            assert_eq!(steps[0].up_to(light), (255.0 * f64::from(light)).round() as u8);
        }
        assert_eq!([0.0, 1.0].map(|light| steps[1].up_to(light)), [4, 202]);
    }

    #[test]
    fn a_gamma_is_the_rounded_power() {
        let Curve::Rounded(steps) = Curve::new(&Transfer::Gamma(2.2), false) else { panic!("not rounded") };
        for i in 0..=20_000 {
            let light = i as f32 / 20_000.0;
            let exact = 255.0 * f64::from(light).powf(1.0 / 2.2);
            assert!((f64::from(steps[2].up_to(light)) - exact).abs() <= 0.5 + 1e-9, "{light}");
        }
    }

    #[test]
    fn dither_keeps_the_mean_to_a_thousandth_of_a_code() {
        for transfer in [Transfer::Srgb, Transfer::Gamma(1.0), Transfer::Gamma(2.6), measured_curve()] {
            let curve = Curve::new(&transfer, true);
            for i in 0..200 {
                // Also light at which no code is, and that of codes themselves.
                let light =
                    if i % 2 == 0 { i as f32 / 200.0 } else { srgb_light(f64::from(i) / 255.0) as f32 };
                for channel in 0..3 {
                    let shine = LightOfCode::of(&transfer, channel);
                    let codes = (0..1024).map(|p| curve.codes([light; 3], [p % 32, p / 32])[channel]);
                    let codes: Vec<f64> = codes.map(f64::from).collect();
                    let lowest = codes.iter().copied().fold(255.0, f64::min);
                    let step = shine.at(lowest + 1.0) - shine.at(lowest);
                    let mean = codes.iter().map(|&code| shine.at(code)).sum::<f64>() / 1024.0;
                    let least =
                        (0..=255).map(|code| shine.at(f64::from(code))).find(|least| least.is_finite());
                    let wanted = f64::from(light).max(least.unwrap());
                    assert!((mean - wanted).abs() < 1e-3 * step, "{transfer:?}, {light}: {mean}");
                }
            }
        }
    }
}
