//! The WGSL of a chain of enhancers, with the glue between them.

use needs::Chain;
use optics::EnhancerKind;
use std::fmt::Write;

/// The WGSL module of a kind, found by its stem.
macro_rules! modules {
    ($($name:ident $stem:ident,)+) => {
        fn module(kind: EnhancerKind) -> &'static str {
            match kind {
                $(EnhancerKind::$name => {
                    include_str!(concat!("../../wgsl/enhance/", stringify!($stem), ".wgsl"))
                })+
            }
        }
    };
}
optics::each_enhancer!(modules);

/// The modules of the links, each once, with the functions that the casting modules call.
pub(super) fn wgsl(chain: &Chain, has_importance: bool) -> String {
    if chain.is_empty() {
        return include_str!("../../wgsl/enhance/none.wgsl").to_owned();
    }
    let mut text = String::from(include_str!("../../wgsl/enhance/chain.wgsl"));
    text += if has_importance {
        include_str!("../../wgsl/enhance/importance.wgsl")
    } else {
        include_str!("../../wgsl/enhance/no_importance.wgsl")
    };
    if chain.kinds().any(EnhancerKind::needs_band) {
        text += include_str!("../../wgsl/enhance/band.wgsl");
    }
    for &kind in EnhancerKind::ALL.iter().filter(|&&kind| chain.kinds().any(|k| k == kind)) {
        text += module(kind);
    }
    text + &glue(chain)
}

/// The chain itself: each hook calls the links in order.
fn glue(chain: &Chain) -> String {
    let links: Vec<&str> = chain.kinds().map(EnhancerKind::stem).collect();
    let each = |line: &dyn Fn(usize, &str) -> String| {
        links.iter().enumerate().fold(String::new(), |text, (i, name)| text + "    " + &line(i, name) + "\n")
    };
    let look = |(i, kind): (usize, EnhancerKind)| {
        let name = kind.stem();
        kind.needs_gradient().then(|| format!("{name}_looks(chain.link{i}.breaks, t)"))
    };
    let looks: Vec<String> =
        std::iter::once("false".to_owned()).chain(chain.kinds().enumerate().filter_map(look)).collect();
    let mut text = String::new();
    write!(
        text,
        "
// The chain of this kernel.
struct Chain {{
    view: vec3<f32>,
{members}}}

var<private> chain: Chain;

fn chain_looks(t: f32) -> bool {{
    return {looks};
}}

fn start_chain(ray: Ray) {{
    chain.view = ray.direction_in_display;
{start}}}

fn follow_chain(ray: Ray) {{
{follow}}}

fn next_break(t: f32) -> f32 {{
    var next = FAR;
{breaks}    return next;
}}

fn enhance(plain: Sample, ray: Ray, t: f32, length: f32, s0: f32, s1: f32, gradients: Gradients) -> Sample {{
    let reach = ray.direction_in_display * (0.5 * length);
    let place = Place(point_in_display(ray, t), reach, {gradient}, s0, s1, chain.view);
    var sample = plain;
{at}    return sample;
}}
",
        members = each(&|i, _| format!("link{i}: LinkState,")),
        looks = looks.join(" || "),
        start = each(&|i, name| format!("chain.link{i}.weights = {name}_start(links[{i}], chain.view);")),
        follow = each(&|i, name| format!(
            "chain.link{i}.breaks = {name}_breaks(links[{i}], chain.link{i}.weights, ray);"
        )),
        breaks = each(&|i, _| format!("next = min(next, first_beyond(chain.link{i}.breaks, t));")),
        gradient = if chain.needs_gradient() { "gradients.at" } else { "vec3<f32>(0.0)" },
        at =
            each(&|i, name| format!("sample = {name}_at(links[{i}], chain.link{i}.weights, sample, place);")),
    )
    .expect("writing to a String does not fail");
    text
}
