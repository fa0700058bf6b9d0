//! Which back-end drives which projectors.

use crate::{ConfigError, Display, Projector};
use std::fmt;
use std::ops::Range;

/// How the projectors of a display are shared among the back-ends that were started.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wiring {
    /// One share for each back-end.
    pub shares: Vec<Share>,
    /// Why they are shared like this.
    pub origin: Origin,
}

/// What one back-end drives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Share {
    /// Its projectors, as indices into the display.
    pub projectors: Vec<u32>,
    /// Part of the name of the graphics adapter it draws with, where the display file names one.
    pub adapter: Option<String>,
}

/// Where a wiring comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// As many back-ends were started as the display file wires.
    File,
    /// One back-end was started where the file wires several: it drives all projectors.
    Single,
    /// Another number was started: the projectors are shared evenly.
    Even {
        /// Back-ends that the file wires.
        wired: usize,
        /// Back-ends that were started.
        started: usize,
    },
}

impl fmt::Display for Origin {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => out.write_str("wired by the display file"),
            Self::Single => out.write_str("all of them, for the only back-end"),
            Self::Even { wired, started } => write!(
                out,
                "shared evenly, because the display file wires {wired} back-end{} and {started} were started",
                if *wired == 1 { "" } else { "s" }
            ),
        }
    }
}

impl Wiring {
    /// One sentence for whoever wired the display, where several back-ends draw other projectors than the display file
    /// says.
    pub fn warning(&self) -> Option<String> {
        let is_even = matches!(self.origin, Origin::Even { .. });
        is_even.then(|| format!("projectors are {}; neighbours stay together", self.origin))
    }
}

impl Display {
    /// What each of a number of back-ends drives. As many back-ends as the display file wires get the projectors and
    /// adapters that the file gives them. Any other number gets contiguous shares, in order, that differ by one at most,
    /// and the adapters that the file names do not apply.
    ///
    /// # Errors
    /// No back-end, or more back-ends than projectors.
    pub fn wiring(&self, backends: usize) -> Result<Wiring, ConfigError> {
        let projectors = self.projectors.len();
        if backends == 0 || backends > projectors {
            return Err(ConfigError::Backends { backends, projectors });
        }
        let wired = self.wired_backends();
        Ok(if backends == wired {
            Wiring { shares: self.wired_shares(), origin: Origin::File }
        } else {
            let even = |share: Range<usize>| Share { projectors: share.map(index).collect(), adapter: None };
            let origin =
                if backends == 1 { Origin::Single } else { Origin::Even { wired, started: backends } };
            Wiring { shares: even_shares(projectors, backends).map(even).collect(), origin }
        })
    }

    /// Whether everything that a back-end drives has pixels of its own on an output.
    ///
    /// # Errors
    /// A projector has no output, or two have the same pixels.
    pub fn check_outputs(&self, share: &Share) -> Result<(), ConfigError> {
        let mut earlier: Vec<&Projector> = Vec::new();
        for &index in &share.projectors {
            let projector = &self.projectors[index as usize];
            let name = || projector.name.clone();
            if projector.raster.output.is_none() {
                return Err(ConfigError::NoOutput { projector: name() });
            }
            if let Some(other) = earlier.iter().find(|other| other.shares_pixels(projector)) {
                return Err(ConfigError::SharedOutput { projector: name(), other: other.name.clone() });
            }
            earlier.push(projector);
        }
        Ok(())
    }

    /// Back-ends that the display file wires; they are numbered without gaps.
    fn wired_backends(&self) -> usize {
        self.projectors.iter().map(|p| p.backend as usize + 1).max().unwrap_or(0)
    }

    fn wired_shares(&self) -> Vec<Share> {
        let adapter = |backend: usize| self.adapters.get(backend).cloned().flatten();
        let share = |backend| Share { projectors: Vec::new(), adapter: adapter(backend) };
        let mut shares: Vec<Share> = (0..self.wired_backends()).map(share).collect();
        for (projector, entry) in self.projectors.iter().enumerate() {
            shares[entry.backend as usize].projectors.push(index(projector));
        }
        shares
    }
}

/// `count` things in order, cut into contiguous shares that differ by one at most.
pub(crate) fn even_shares(count: usize, parts: usize) -> impl Iterator<Item = Range<usize>> {
    (0..parts).map(move |part| part * count / parts..(part + 1) * count / parts)
}

fn index(projector: usize) -> u32 {
    u32::try_from(projector).expect("a display's file cannot list 2^32 projectors")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn projectors(wiring: &Wiring) -> Vec<Vec<u32>> {
        wiring.shares.iter().map(|share| share.projectors.clone()).collect()
    }

    #[test]
    fn shares_are_whole_contiguous_and_equal_to_one() {
        let display = Display::load("holo72").unwrap();
        for backends in 1..=72 {
            let shares = projectors(&display.wiring(backends).unwrap());
            assert_eq!(shares.len(), backends);
            assert_eq!(shares.concat(), (0..72).collect::<Vec<u32>>());
            let sizes = || shares.iter().map(Vec::len);
            assert!(sizes().max().unwrap() - sizes().min().unwrap() <= 1);
        }
    }

    #[test]
    fn the_file_s_number_of_back_ends_gets_the_file_s_wiring() {
        let mut display = Display::load("desk8").unwrap();
        for (projector, backend) in display.projectors.iter_mut().zip([2, 0, 1, 0, 1, 0, 0, 2]) {
            projector.backend = backend;
        }
        display.adapters = vec![Some("one".into()), None];
        let wiring = display.wiring(3).unwrap();
        assert_eq!(projectors(&wiring), [vec![1, 3, 5, 6], vec![2, 4], vec![0, 7]]);
        let adapters: Vec<_> = wiring.shares.iter().map(|share| share.adapter.as_deref()).collect();
        assert_eq!(adapters, [Some("one"), None, None]);
        assert_eq!((wiring.origin, wiring.warning()), (Origin::File, None));
    }

    #[test]
    fn any_other_number_gets_even_shares_and_a_sentence() {
        let mut display = Display::load("desk8").unwrap();
        display.adapters = vec![Some("one".into()); 4];
        let three = display.wiring(3).unwrap();
        assert_eq!(projectors(&three), [vec![0, 1], vec![2, 3, 4], vec![5, 6, 7]]);
        assert!(three.shares.iter().all(|share| share.adapter.is_none()));
        assert_eq!(
            three.warning().unwrap(),
            "projectors are shared evenly, because the display file wires 4 back-ends and 3 were started; neighbours \
             stay together"
        );
        let one = display.wiring(1).unwrap();
        assert_eq!((one.origin, one.warning()), (Origin::Single, None));
        assert_eq!(projectors(&one), [(0..8).collect::<Vec<u32>>()]);
    }

    #[test]
    fn too_many_back_ends_are_refused_in_a_sentence() {
        let display = Display::load("desk8").unwrap();
        let message = display.wiring(9).unwrap_err().to_string();
        assert_eq!(message, "cannot share 8 projectors among 9 back-ends; start from 1 to 8 of them");
        assert!(matches!(display.wiring(0), Err(ConfigError::Backends { backends: 0, projectors: 8 })));
    }
    #[test]
    fn what_is_driven_has_an_output_of_its_own() {
        let text =
            std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/presets/desk8.toml")).unwrap();
        let display = Display::from_toml(&format!("{text}outputs = [\"A\", \"B\"]\n"), "desk8").unwrap();
        let checked = |backends: usize| {
            let shares = display.wiring(backends).unwrap().shares;
            shares
                .iter()
                .try_for_each(|share| display.check_outputs(share))
                .map_err(|error| error.to_string())
        };
        assert_eq!(checked(4), Ok(()));
        assert!(
            checked(2).unwrap_err().contains("projectors `projector-0` and `projector-2` of one back-end")
        );
        let plain = Display::load("desk8").unwrap();
        let refused = plain.check_outputs(&plain.wiring(4).unwrap().shares[0]).unwrap_err().to_string();
        assert!(refused.contains("projector `projector-0` has no output"), "{refused}");
    }
}
