//! The bands and enhancers in a scene file.

use crate::scene::error::Checked;
use crate::scene::file::{BandTable, EnhancerTable, Key, Limits, Number, Triple, key};
use crate::scene::text::SceneText;
use crate::scene::usual::{AWAY, EDGES, FACING, GRADIENT_MOST, RADIUS_M, THICKNESS_M, TOWARD};
use crate::scene::{Anchor, Band, CLIP_CONTEXT, SceneEnhancer};
use ::optics::{
    BandPicker, ClipPlane, Enhancer, EnhancerKind, LayerOpacity, MOST_ENHANCERS, Probe, Ramp, Trapezoid,
};
use display_config::text::{brief_text, did_you_mean};
use glam::DVec3;
use toml::Spanned;

/// Keys that a tool overrides for an enhancer that it carries.
const OF_THE_TOOL: [&str; 4] = ["point_m", "normal", "centre_m", "axis"];

impl EnhancerTable {
    /// The keys that are given, with their places; `kind` and `carried` aside.
    fn given(&self) -> impl Iterator<Item = Key> {
        let keys = [
            key("band", &self.band),
            key("point_m", &self.point_m),
            key("normal", &self.normal),
            key("context", &self.context),
            key("thickness_m", &self.thickness_m),
            key("boost", &self.boost),
            key("centre_m", &self.centre_m),
            key("radius_m", &self.radius_m),
            key("axis", &self.axis),
            key("facing", &self.facing),
            key("gradient_most", &self.gradient_most),
            key("edges", &self.edges),
            key("away", &self.away),
            key("toward", &self.toward),
            key("strength", &self.strength),
        ];
        keys.into_iter().flatten()
    }

    fn is_carried(&self) -> bool {
        self.carried.as_ref().is_some_and(|carried| *carried.get_ref())
    }
}

impl SceneText {
    pub(super) fn bands(&self, tables: &[BandTable]) -> Checked<Vec<Band>> {
        let mut bands: Vec<Band> = Vec::with_capacity(tables.len());
        for table in tables {
            let name = table.name.get_ref();
            if bands.iter().any(|band| band.name == *name) {
                let message = format!("another band is already called `{name}`; give each band its own name");
                return Err(self.wrong(table.name.span(), message));
            }
            let values = Trapezoid::new(table.corners.get_ref().0);
            let values = values.map_err(|error| self.wrong(table.corners.span(), error.to_string()))?;
            bands.push(Band { name: name.clone(), values });
        }
        Ok(bands)
    }

    /// The band of a name.
    pub(super) fn band(&self, name: &Spanned<String>, bands: &[Band]) -> Checked<Trapezoid> {
        let found = bands.iter().find(|band| band.name == *name.get_ref());
        let names: Vec<&str> = bands.iter().map(|band| band.name.as_str()).collect();
        let known = if names.is_empty() { "add a [[band]]".to_owned() } else { names.join(", ") };
        let message = || {
            let suggestion = did_you_mean(name.get_ref(), names.iter().copied());
            let name = brief_text(name.get_ref());
            format!("there is no band `{name}`{suggestion}; use one of the scene's bands: {known}")
        };
        found.map(|band| band.values).ok_or_else(|| self.wrong(name.span(), message()))
    }

    /// The chain, in the order of the file.
    pub(super) fn enhancers(
        &self,
        tables: &[EnhancerTable],
        bands: &[Band],
        has_tool: bool,
    ) -> Checked<Vec<SceneEnhancer>> {
        if let Some(extra) = tables.get(MOST_ENHANCERS) {
            let message = format!("at most {MOST_ENHANCERS} enhancers can be chained; remove this one");
            return Err(self.wrong(extra.kind.span(), message));
        }
        for (place, table) in tables.iter().enumerate() {
            self.check_keys(table)?;
            self.check_carrying(table, &tables[..place], has_tool)?;
        }
        tables.iter().map(|table| self.enhancer(table, bands)).collect()
    }

    fn check_keys(&self, table: &EnhancerTable) -> Checked<()> {
        let kind = *table.kind.get_ref();
        let Some((name, span)) = table.given().find(|(name, _)| !kind.keys().contains(name)) else {
            return Ok(());
        };
        let keys = kind.keys().join(", ");
        Err(self.wrong(span, format!("a {} has no {name}; its keys are {keys}", kind.name())))
    }

    fn check_carrying(&self, table: &EnhancerTable, before: &[EnhancerTable], has_tool: bool) -> Checked<()> {
        let Some(carried) = table.carried.as_ref().filter(|_| table.is_carried()) else { return Ok(()) };
        if !has_tool {
            return Err(self.wrong(carried.span(), "the scene has no tool to carry it; add a [tool] table"));
        }
        let kind = table.kind.get_ref();
        if before.iter().any(|other| other.is_carried() && other.kind.get_ref() == kind) {
            let message = format!("the tool carries a {} already; at most one of a kind", kind.name());
            return Err(self.wrong(carried.span(), message));
        }
        match table.given().find(|(name, _)| OF_THE_TOOL.contains(name)) {
            Some((_, span)) => {
                Err(self.wrong(span, "the tool that carries it decides this; remove this line"))
            }
            None => Ok(()),
        }
    }

    fn enhancer(&self, table: &EnhancerTable, bands: &[Band]) -> Checked<SceneEnhancer> {
        let place = table.point_m.as_ref().or(table.centre_m.as_ref());
        let anchor = match place.map(|place| self.point(place)).transpose()? {
            _ if table.is_carried() => Anchor::Tool,
            Some(point) => Anchor::Point(point),
            None => Anchor::Volume,
        };
        let numbers = match table.kind.get_ref() {
            EnhancerKind::ClipPlane => Enhancer::ClipPlane(self.clip_plane(table)?),
            EnhancerKind::Probe => Enhancer::Probe(self.probe(table)?),
            EnhancerKind::BandPicker => Enhancer::BandPicker(self.band_picker(table, bands)?),
            EnhancerKind::LayerOpacity => Enhancer::LayerOpacity(self.layer_opacity(table, bands)?),
        };
        self.within_bounds(numbers.check(), table.given(), table.kind.span())?;
        Ok(SceneEnhancer { numbers, anchor })
    }

    fn clip_plane(&self, table: &EnhancerTable) -> Checked<ClipPlane> {
        Ok(ClipPlane {
            point_in_display: DVec3::ZERO,
            normal_in_display: self.direction_or(&table.normal, DVec3::Z)?,
            context: self.ramp_or(&table.context, CLIP_CONTEXT)?,
            thickness_m: self.at_least_zero_or(&table.thickness_m, THICKNESS_M)?,
            boost: self.at_least_zero_or(&table.boost, ClipPlane::OPAQUE)?,
            strength: self.within_or(&table.strength, 1.0, 0.0..=1.0)?,
        })
    }

    fn probe(&self, table: &EnhancerTable) -> Checked<Probe> {
        Ok(Probe {
            centre_in_display: DVec3::ZERO,
            radius_m: self.within_or(&table.radius_m, RADIUS_M, f64::MIN_POSITIVE..=f64::MAX)?,
            axis_in_display: self.direction_or(&table.axis, DVec3::NEG_Z)?,
            facing: self.ramp_or(&table.facing, FACING)?,
            gradient_most: self.within_or(
                &table.gradient_most,
                GRADIENT_MOST,
                f64::MIN_POSITIVE..=f64::MAX,
            )?,
            edges: self.ramp_or(&table.edges, EDGES)?,
            strength: self.within_or(&table.strength, 1.0, 0.0..=1.0)?,
        })
    }

    fn band_picker(&self, table: &EnhancerTable, bands: &[Band]) -> Checked<BandPicker> {
        Ok(BandPicker {
            band: self.band_of_enhancer(table, bands)?,
            axis_in_display: self.direction_or(&table.axis, DVec3::NEG_Z)?,
            facing: self.ramp_or(&table.facing, FACING)?,
            strength: self.within_or(&table.strength, 1.0, 0.0..=1.0)?,
        })
    }

    fn layer_opacity(&self, table: &EnhancerTable, bands: &[Band]) -> Checked<LayerOpacity> {
        Ok(LayerOpacity {
            band: self.band_of_enhancer(table, bands)?,
            axis_in_display: self.direction_or(&table.axis, DVec3::NEG_Z)?,
            facing: self.ramp_or(&table.facing, FACING)?,
            away: self.at_least_zero_or(&table.away, AWAY)?,
            toward: self.at_least_zero_or(&table.toward, TOWARD)?,
        })
    }

    fn band_of_enhancer(&self, table: &EnhancerTable, bands: &[Band]) -> Checked<Trapezoid> {
        let message = || format!("a {} needs the name of a band; add band", table.kind.get_ref().name());
        let name = table.band.as_ref().ok_or_else(|| self.wrong(table.kind.span(), message()))?;
        self.band(name, bands)
    }

    fn direction_or(&self, direction: &Option<Triple>, otherwise: DVec3) -> Checked<DVec3> {
        direction.as_ref().map_or(Ok(otherwise), |direction| self.direction(direction))
    }

    fn ramp_or(&self, limits: &Option<Limits>, otherwise: Ramp) -> Checked<Ramp> {
        let Some(limits) = limits else { return Ok(otherwise) };
        let (low, high) = self.rising(limits)?;
        Ok(Ramp { low, high })
    }

    fn at_least_zero_or(&self, number: &Option<Number>, otherwise: f64) -> Checked<f64> {
        self.within_or(number, otherwise, 0.0..=f64::MAX)
    }
}
