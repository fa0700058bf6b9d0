//! Counts of all that arrives from the sources of a file.

use super::channel::{Channel, ChannelReport, Tally};
use inputs::{Counts, Event, Input, What};
use serde::Serialize;
use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

/// Sentences that are kept.
const MOST_SENTENCES: usize = 100;

/// Counts by source and channel.
pub struct Meter {
    sources: Vec<Source>,
    sentences: VecDeque<String>,
    lap_began: Duration,
}

struct Source {
    name: String,
    kind: &'static str,
    is_there: bool,
    tallies: BTreeMap<Channel, Tally>,
}

/// What arrived in all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InputsReport {
    /// For how long, seconds.
    pub seconds: f64,
    /// By source, in the order of the file.
    pub sources: Vec<SourceReport>,
    /// What became of sources, each with its name; the latest of many.
    pub sentences: VecDeque<String>,
}

/// What arrived from a source.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SourceReport {
    /// What people call it.
    pub name: String,
    /// Its protocol.
    pub kind: &'static str,
    /// Whether it is there now.
    pub is_there: bool,
    /// Its messages.
    #[serde(flatten)]
    pub counts: Counts,
    /// By sensor, button and axis.
    pub channels: Vec<ChannelReport>,
}

impl Meter {
    /// Nothing has arrived yet.
    pub fn new(inputs: &[Input]) -> Self {
        let source = |input: &Input| Source {
            name: input.name.clone(),
            kind: input.kind.name(),
            is_there: false,
            tallies: BTreeMap::new(),
        };
        let sources = inputs.iter().map(source).collect();
        Self { sources, sentences: VecDeque::new(), lap_began: Duration::ZERO }
    }

    /// Counts an event. The sentence that tells people what became of its source, if it does.
    pub fn add(&mut self, event: &Event) -> Option<String> {
        let source = self.sources.get_mut(usize::from(event.source.0))?;
        if let Some((channel, last)) = Channel::of(&event.what) {
            source.tallies.entry(channel).or_default().add(event, last);
            return None;
        }
        let (What::Found(sentence) | What::Lost(sentence)) = &event.what else { return None };
        source.is_there = matches!(event.what, What::Found(_));
        let sentence = format!("{}: {sentence}", source.name);
        if self.sentences.len() == MOST_SENTENCES {
            self.sentences.pop_front();
        }
        self.sentences.push_back(sentence.clone());
        Some(sentence)
    }

    /// What has arrived until now, and since the last lap: then rates are those of the lap.
    pub fn lap(&mut self, now: Duration, counts: Vec<Counts>) -> InputsReport {
        let lap_s = now.saturating_sub(self.lap_began).as_secs_f64().max(1e-3);
        self.lap_began = now;
        let mut report = self.report(now, counts);
        for (source, reported) in self.sources.iter_mut().zip(&mut report.sources) {
            for (tally, channel) in source.tallies.values_mut().zip(&mut reported.channels) {
                channel.rate_hz = tally.lap() as f64 / lap_s;
            }
        }
        report
    }

    /// What has arrived until now. Counts are those of the hub, in its order.
    pub fn report(&self, now: Duration, counts: Vec<Counts>) -> InputsReport {
        let report = |(source, counts): (&Source, Counts)| SourceReport {
            name: source.name.clone(),
            kind: source.kind,
            is_there: source.is_there,
            counts,
            channels: source.tallies.iter().map(|(&channel, tally)| tally.report(channel, now)).collect(),
        };
        InputsReport {
            seconds: now.as_secs_f64(),
            sources: self.sources.iter().zip(counts).map(report).collect(),
            sentences: self.sentences.clone(),
        }
    }
}

#[cfg(test)]
#[path = "meter_tests.rs"]
mod tests;
