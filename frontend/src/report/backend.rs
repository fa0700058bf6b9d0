//! What a back-end drew with, and why.

use display_config::Wiring;
use protocol::DeviceInfo;
use serde::Serialize;

/// A back-end, in brief.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BackendSummary {
    /// The projectors that it drew, as indices into the display.
    pub projectors: Vec<u32>,
    /// Why these.
    pub why_these: String,
    /// Its device, and why it is this one.
    #[serde(flatten)]
    pub device: DeviceInfo,
}

impl BackendSummary {
    /// Of all back-ends, each with its device.
    pub fn all(wiring: &Wiring, devices: Vec<DeviceInfo>) -> Vec<Self> {
        let why_these = wiring.origin.to_string();
        let shares = wiring.shares.iter().map(|share| share.projectors.clone());
        let summary = |(projectors, device)| Self { projectors, why_these: why_these.clone(), device };
        shares.zip(devices).map(summary).collect()
    }

    /// Its projectors as people list them: `0 to 17`, or `0, 2 to 4, 7`.
    pub fn listed_projectors(&self) -> String {
        let runs = self.projectors.chunk_by(|before, after| before + 1 == *after);
        let text = |run: &[u32]| match *run {
            [first, .., last] => format!("{first} to {last}"),
            _ => run.iter().map(u32::to_string).collect(),
        };
        runs.map(text).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use display_config::{Origin, Share};

    #[test]
    fn neighbours_are_listed_together() {
        for (projectors, expected) in [
            (vec![], ""),
            (vec![3], "3"),
            (vec![0, 1], "0 to 1"),
            (vec![0, 2, 3, 4, 7], "0, 2 to 4, 7"),
            ((4..72).collect(), "4 to 71"),
        ] {
            let wiring = Wiring { shares: vec![Share { projectors, adapter: None }], origin: Origin::Single };
            let [adapter, reason, filter] = [String::new(), String::new(), String::new()];
            let device = DeviceInfo { adapter, reason, filter, cache_bytes: 0 };
            assert_eq!(BackendSummary::all(&wiring, vec![device])[0].listed_projectors(), expected);
        }
    }
}
