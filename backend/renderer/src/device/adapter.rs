//! Which of a host's graphics adapters a back-end draws with; no adapter is opened here.

use protocol::AdapterWish;

/// What kind of adapter, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum AdapterKind {
    /// A graphics card.
    Discrete,
    /// A part of the processor.
    Integrated,
    /// A part of another machine's, or of a kind that its driver does not name.
    Other,
    /// A driver that draws on the processor.
    Software,
}

/// An adapter that a driver offers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct OfferedAdapter {
    /// What the driver calls it.
    pub name: String,
    /// Its kind.
    pub kind: AdapterKind,
    /// Where it sits in this host; empty where the driver does not say.
    pub bus: String,
}

/// The adapter for a back-end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ChosenAdapter {
    /// Its place in the list of those offered.
    pub index: usize,
    /// Why this one: part of a sentence.
    pub why: String,
}

/// The adapter that a back-end's wish leads to. By name: one whose name has the wish's in it, in capitals or not. Without a
/// name: one of the best kind there is. Where several fit, back-ends take turns.
///
/// # Errors
/// There is none, or none of that name: a sentence.
pub(super) fn choose_adapter(
    offered: &[OfferedAdapter],
    wish: &AdapterWish,
) -> Result<ChosenAdapter, String> {
    let places = distinct(offered);
    let kind = |&place: &usize| offered[place].kind;
    let (fitting, what) = match &wish.name {
        Some(name) => {
            let has_name =
                |&place: &usize| offered[place].name.to_lowercase().contains(&name.trim().to_lowercase());
            let fitting: Vec<usize> = places.iter().copied().filter(has_name).collect();
            if fitting.is_empty() {
                return Err(nothing_called(name, &places, offered));
            }
            (fitting, format!("the display file asks for `{name}`"))
        }
        None => {
            let best = places.iter().map(kind).min();
            let fitting = places.iter().copied().filter(|place| Some(kind(place)) == best).collect();
            (fitting, "a driver offers it".to_owned())
        }
    };
    let turn = match fitting.len() {
        0 => return Err("no Vulkan driver offers an adapter".to_owned()),
        count => wish.turn as usize % count,
    };
    let why = match fitting.len() {
        1 => what,
        count => format!(
            "{what}; it is number {} of {count} such adapters, which back-ends take in turn",
            turn + 1
        ),
    };
    Ok(ChosenAdapter { index: fitting[turn], why })
}

/// The places of the adapters, each card once: two drivers may offer the same one.
fn distinct(offered: &[OfferedAdapter]) -> Vec<usize> {
    let is_again = |place: usize| {
        let bus = &offered[place].bus;
        !bus.is_empty() && offered[..place].iter().any(|earlier| earlier.bus == *bus)
    };
    (0..offered.len()).filter(|&place| !is_again(place)).collect()
}

fn nothing_called(name: &str, places: &[usize], offered: &[OfferedAdapter]) -> String {
    let names: Vec<String> = places.iter().map(|&place| format!("`{}`", offered[place].name)).collect();
    let there_is = if names.is_empty() {
        "there is none at all".to_owned()
    } else {
        format!("there is {}", names.join(", "))
    };
    format!(
        "no graphics adapter of this host is called `{name}`: {there_is}; correct `adapter` in the display file"
    )
}

#[cfg(test)]
mod tests {
    use super::AdapterKind::{Discrete, Integrated, Software};
    use super::*;

    fn offered(adapters: &[(&str, AdapterKind, &str)]) -> Vec<OfferedAdapter> {
        let adapter = |&(name, kind, bus): &(&str, AdapterKind, &str)| OfferedAdapter {
            name: name.into(),
            kind,
            bus: bus.into(),
        };
        adapters.iter().map(adapter).collect()
    }

    /// Two cards, what the processor holds, and a driver in software.
    fn workstation() -> Vec<OfferedAdapter> {
        offered(&[
            ("Iris Xe", Integrated, "00:02.0"),
            ("RTX 6000 Ada", Discrete, "41:00.0"),
            ("llvmpipe", Software, ""),
            ("RTX A400", Discrete, "61:00.0"),
        ])
    }

    fn index(offered: &[OfferedAdapter], turn: u32, name: Option<&str>) -> Result<usize, String> {
        let wish = AdapterWish { turn, name: name.map(str::to_owned) };
        choose_adapter(offered, &wish).map(|chosen| chosen.index)
    }

    #[test]
    fn back_ends_of_a_host_take_the_best_adapters_in_turn() {
        let taken: Vec<_> = (0..4).map(|turn| index(&workstation(), turn, None).unwrap()).collect();
        assert_eq!(taken, [1, 3, 1, 3]);
        let laptop = offered(&[("llvmpipe", Software, ""), ("Iris Xe", Integrated, "00:02.0")]);
        assert_eq!((index(&laptop, 0, None), index(&laptop, 1, None)), (Ok(1), Ok(1)));
        assert_eq!(index(&laptop[..1], 3, None), Ok(0));
        assert_eq!(index(&[], 0, None).unwrap_err(), "no Vulkan driver offers an adapter");
    }

    #[test]
    fn a_name_takes_any_adapter_that_bears_it() {
        for (name, turn, expected) in
            [("a400", 0, 3), ("A400", 7, 3), (" rtx ", 0, 1), ("RTX", 1, 3), ("iris", 5, 0), ("LLVM", 0, 2)]
        {
            assert_eq!(index(&workstation(), turn, Some(name)), Ok(expected), "{name}");
        }
    }

    #[test]
    fn a_name_that_no_adapter_bears_is_answered_with_what_there_is() {
        assert_eq!(
            index(&workstation()[1..3], 0, Some("RTX 5000")).unwrap_err(),
            "no graphics adapter of this host is called `RTX 5000`: there is `RTX 6000 Ada`, `llvmpipe`; correct \
             `adapter` in the display file"
        );
        assert!(index(&[], 0, Some("x")).unwrap_err().contains("there is none at all"));
    }

    #[test]
    fn a_card_that_two_drivers_offer_counts_once() {
        let twice =
            offered(&[("A", Discrete, "1"), ("A (second driver)", Discrete, "1"), ("B", Discrete, "2")]);
        let taken: Vec<_> = (0..3).map(|turn| index(&twice, turn, None).unwrap()).collect();
        assert_eq!(taken, [0, 2, 0]);
    }

    #[test]
    fn the_reason_says_whose_wish_and_whose_turn_it_was() {
        let why = |turn, name: Option<&str>| {
            let wish = AdapterWish { turn, name: name.map(str::to_owned) };
            choose_adapter(&workstation(), &wish).unwrap().why
        };
        assert_eq!(why(0, Some("iris")), "the display file asks for `iris`");
        let in_turn = "it is number 2 of 2 such adapters, which back-ends take in turn";
        assert_eq!(why(1, Some("rtx")), format!("the display file asks for `rtx`; {in_turn}"));
        assert_eq!(why(3, None), format!("a driver offers it; {in_turn}"));
    }
}
