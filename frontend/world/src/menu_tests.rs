//! Laws of menus.

use super::*;
use proptest::prelude::*;

const SIZE: MenuSize =
    MenuSize { entry_m: DVec2::new(0.1, MenuSize::LEAST_M), most_rows: 6, most_columns: 3 };

/// Rounding of lengths below a metre.
const ROUNDING_M: f64 = 1e-15;
/// How far hands tremble to each side, metres.
const TREMOR_M: f64 = 0.002;

fn menu(groups: &[usize]) -> Menu {
    let groups: Vec<Vec<Choice>> = groups.iter().map(|&size| (0..size).map(Choice::Item).collect()).collect();
    Menu::new(ToolId(0), DVec3::new(-0.1, 0.2, 0.3), &groups, &SIZE).unwrap()
}

#[test]
fn a_long_list_goes_on_in_the_next_column_with_a_whole_group_where_that_is_possible() {
    let columns = |groups: &[usize]| -> Vec<usize> {
        let mut counts = vec![0; 4];
        SIZE.places(groups.iter().copied()).iter().for_each(|place| counts[place[0]] += 1);
        counts
    };
    assert_eq!(columns(&[1, 2, 3]), [6, 0, 0, 0]);
    assert_eq!(columns(&[1, 3, 3]), [4, 3, 0, 0]);
    assert_eq!(columns(&[1, 8, 2]), [1, 6, 4, 0], "8 fit no column");
    assert_eq!(columns(&[20]), [6, 6, 6, 2]);
}

#[test]
fn lists_open_beside_the_tip_toward_the_middle_of_the_screen() {
    for x in [-0.2, 0.2] {
        let menu = Menu::new(ToolId(0), DVec3::X * x, &[vec![Choice::Undo; 3]], &SIZE).unwrap();
        let [least, most] = menu.corners_m();
        let beside = if x < 0.0 { least.x } else { -most.x };
        assert!((beside - GAP_M).abs() < ROUNDING_M, "{beside}");
        assert!((least.y + most.y).abs() < ROUNDING_M, "half above, half below");
    }
    assert_eq!(Menu::new(ToolId(0), DVec3::ZERO, &[Vec::new()], &SIZE), None);
}

proptest! {
    #[test]
    fn what_trembles_changes_the_mark_once(
        x in 0.0..0.35_f64,
        y in -0.06..0.06_f64,
        moves in prop::collection::vec((-TREMOR_M..TREMOR_M, -TREMOR_M..TREMOR_M), 1..100),
    ) {
        let mut menu = menu(&[5, 4, 3]);
        let still = menu.from_m + DVec3::new(x, y, 0.0);
        let changes = moves.iter().filter(|&&(x, y)| menu.mark(still + DVec3::new(x, y, 0.0))).count();
        prop_assert!(changes <= 1, "{changes}");
    }

    #[test]
    fn the_middle_of_each_entry_marks_it_from_any_other_whatever_trembles(
        from in 0..12_usize,
        to in 0..12_usize,
        (x, y) in (-TREMOR_M..TREMOR_M, -TREMOR_M..TREMOR_M),
    ) {
        let mut menu = menu(&[5, 4, 3]);
        for entry in [from, to] {
            let at = menu.from_m + menu.entries[entry].middle_m.extend(0.1);
            menu.mark(at + DVec3::new(x, y, 0.0));
            prop_assert_eq!(menu.marked, Some(entry));
        }
        let beside = menu.from_m;
        prop_assert!(menu.mark(beside) && menu.choice().is_none());
    }

    /// What [`MenuSize::has_room`] relies on.
    #[test]
    fn less_on_the_list_never_takes_more_columns(groups in prop::collection::vec((0..9_usize, 0..9_usize), 0..6)) {
        let columns = |less: bool| {
            let sizes = groups.iter().map(|&(size, left_out)| size - if less { left_out.min(size) } else { 0 });
            SIZE.places(sizes).iter().map(|place| place[0] + 1).max()
        };
        prop_assert!(columns(true) <= columns(false));
    }
}
