//! Every kernel is valid WGSL, and lays its structs out as the host does.

use layout::present::{Layer, MarkedPixel};
use layout::{
    FanBlock, FeedbackEntry, ImportanceEntry, IndexEntry, Link, NodeRecord, PaintBlock, PlaneBand,
    PlaneLayer, PlaneVariation, PresentBlock, SceneBlock, TableCell, TableEntry, ViewBlock, binding,
};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use needs::Needs;
use shaders::compose::{
    KernelKey, KernelRays, PAINT_CORNER, PAINT_PIXEL, PlaneStep, PresentKernel, paint_wgsl, tally_wgsl,
};
use std::mem::{offset_of, size_of};

fn parse(wgsl: &str) -> naga::Module {
    match naga::front::wgsl::parse_str(wgsl) {
        Ok(module) => module,
        Err(error) => panic!("{}", error.emit_to_string(wgsl)),
    }
}

fn is_valid(wgsl: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
    Validator::new(ValidationFlags::all(), Capabilities::default())
        .validate(&module)
        .map(|_| ())
        .map_err(|error| error.emit_to_string(wgsl))
}

#[test]
fn every_permutation_is_valid() {
    for key in KernelKey::samples() {
        if let Err(why) = is_valid(&key.wgsl()) {
            panic!("{key:?}: {why}");
        }
    }
    for wgsl in [tally_wgsl(), paint_wgsl()] {
        if let Err(why) = is_valid(&wgsl) {
            panic!("{why}");
        }
    }
    assert!([PAINT_CORNER, PAINT_PIXEL].iter().all(|entry| paint_wgsl().contains(&format!("fn {entry}("))));
    for kernel in PresentKernel::ALL {
        let wgsl = kernel.wgsl();
        assert!(wgsl.contains(&format!("fn {}(", kernel.entry_point())), "{kernel:?}");
        if let Err(why) = is_valid(&wgsl) {
            panic!("{kernel:?}: {why}");
        }
    }
}

#[test]
fn bindings_have_the_numbers_of_the_table_and_no_others() {
    let of_rays = KernelKey::samples().into_iter().map(|key| key.wgsl());
    let others = PresentKernel::ALL.map(PresentKernel::wgsl).into_iter().chain([tally_wgsl(), paint_wgsl()]);
    for wgsl in of_rays.chain(others) {
        assert!(wgsl.split("@binding(").skip(1).all(|rest| rest.starts_with("BINDING_")), "{wgsl}");
    }
    let module = parse(&KernelKey::samples()[0].wgsl());
    let number = |name: &str| {
        let (_, found) =
            module.global_variables.iter().find(|(_, global)| global.name.as_deref() == Some(name)).unwrap();
        found.binding.unwrap().binding
    };
    assert_eq!((number("scene"), number("views")), (binding::SCENE, binding::VIEWS));
    assert_eq!((number("nodes"), number("feedback")), (binding::NODES, binding::FEEDBACK));
}

#[test]
fn blending_is_seen_with_every_slot_that_looks_at_it_and_no_more() {
    let keys = KernelKey::samples();
    let blended: Vec<_> = keys.iter().filter(|key| key.needs.blends).collect();
    for key in &keys {
        let slots = |key: &KernelKey| (key.needs.levels, key.needs.shading, key.needs.way);
        assert!(blended.iter().any(|other| slots(other) == slots(key)), "{key:?}");
    }
    assert!(8 * blended.len() < keys.len(), "{} of {}", blended.len(), keys.len());
}

#[test]
fn a_spoiled_kernel_is_not_valid() {
    let key = KernelKey::samples()[0];
    assert!(is_valid(&key.wgsl().replace("fn lighting(", "fn not_lighting(")).is_err());
}

fn offsets(module: &naga::Module, name: &str) -> (Vec<(String, u32)>, u32) {
    let (_, found) =
        module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).expect("the kernel declares it");
    match &found.inner {
        naga::TypeInner::Struct { members, span } => (
            members.iter().map(|m| (m.name.clone().expect("WGSL members have names"), m.offset)).collect(),
            *span,
        ),
        other => panic!("{name} is not a struct but {other:?}"),
    }
}

macro_rules! assert_layout {
    ($module:expr, $host:ty, $($member:ident),+) => {{
        let name = stringify!($host);
        let host = vec![$((stringify!($member).to_string(), offset_of!($host, $member) as u32)),+];
        assert_eq!(offsets($module, name), (host, size_of::<$host>() as u32), "{name}");
    }};
}

#[test]
fn host_structs_and_wgsl_structs_agree() {
    let key = KernelKey::samples()
        .into_iter()
        .find(|key| key.needs.reads_importance() && !key.needs.chain.is_empty())
        .unwrap();
    let module = parse(&key.wgsl());
    assert_layout!(
        &module,
        SceneBlock,
        volume_from_display,
        volume,
        light,
        material,
        quality,
        mimda,
        texel,
        atlas,
        tables,
        resolution
    );
    assert_layout!(&module, ViewBlock, screen_from_pixel, beam, raster, lattice);
    assert_layout!(
        &module,
        NodeRecord,
        cell,
        depth,
        parent,
        first_child,
        slot,
        deficit,
        offset,
        scale,
        neighbours,
        most_extinction,
        weights,
        deviation_scale
    );
    assert_layout!(&module, TableCell, first, occupied, inside);
    assert_layout!(&module, TableEntry, value, integral, integral_rest, position, padding);
    assert_layout!(&module, ImportanceEntry, value, integral, integral_rest, padding);
    assert_layout!(&module, IndexEntry, value, slope, jumps);
    assert_layout!(&module, FeedbackEntry, deficit_code, rays);
    assert_layout!(&module, Link, a, b, c, d);
    let step = KernelRays::OfPlanes(PlaneStep::Errors);
    let module = parse(&KernelKey { rays: step, needs: Needs::PLAIN, ..key }.wgsl());
    assert_layout!(
        &module,
        FanBlock,
        raster,
        way,
        most_spacing_error,
        most_mean_error,
        views,
        blocks,
        sweeps,
        step,
        first_row,
        rows,
        bands
    );
    assert_layout!(
        &module,
        PlaneBand,
        at,
        first_layer,
        layers,
        first_column,
        columns,
        first_block,
        blocks,
        padding
    );
    assert_layout!(
        &module,
        PlaneLayer,
        z,
        slab_z,
        phases,
        first,
        width,
        at,
        block_at,
        has_cell,
        has_cell_before,
        padding
    );
    assert_layout!(&module, PlaneVariation, most, importance, padding, each, value);
    let module = parse(&PresentKernel::Finish.wgsl());
    assert_layout!(&module, PresentBlock, raster, steps, numbers, stages, black);
    let module = parse(&PresentKernel::Layers.wgsl());
    assert_layout!(&module, Layer, before, rgb, opacity);
    assert_layout!(&module, MarkedPixel, pixel, first, count);
    let module = parse(&paint_wgsl());
    assert_layout!(&module, PaintBlock, place, source, steps);
}
