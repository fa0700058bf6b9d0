//! The look in a scene file.

use crate::scene::error::Checked;
use crate::scene::file::{MimdaTable, OpticsTable, Points, SceneFile};
use crate::scene::look::DataLook;
use crate::scene::text::SceneText;
use ::optics::{Curve, CurveError, CurveValue, Material, Mimda, MimdaForm, Optics, OpticsError};
use glam::DVec3;
use toml::Spanned;

impl SceneText {
    /// The look of the file; None if it leaves it to the volume.
    pub(super) fn look(&self, file: &SceneFile) -> Checked<Option<DataLook>> {
        let Some(optics) = &file.optics else {
            return match &file.mimda {
                Some(mimda) => {
                    Err(self.wrong(mimda.span(), "it needs optics.importance; add an [optics] table"))
                }
                None => Ok(None),
            };
        };
        let has_light = file.light.is_some();
        Ok(Some(DataLook {
            domain: optics.domain.as_ref().map(|domain| self.rising(domain)).transpose()?,
            extinction: self.extinction(&optics.extinction)?,
            extinction_unit: optics.extinction_unit,
            colour: self.colour(&optics.colour)?,
            mimda: self.mimda(optics, file.mimda.as_ref())?,
            refraction: optics.refraction.as_ref().map(|points| self.refraction(points)).transpose()?,
            materials: optics.materials.as_ref().map(|m| self.materials(m, has_light)).transpose()?,
        }))
    }

    fn mimda(&self, optics: &OpticsTable, table: Option<&Spanned<MimdaTable>>) -> Checked<Option<Mimda>> {
        match (&optics.importance, table) {
            (None, None) => Ok(None),
            (None, Some(table)) => Err(self.wrong(table.span(), "it needs optics.importance; add that key")),
            (Some(points), None) => {
                Err(self.wrong(points.span(), "it does nothing without a [mimda] table; add one"))
            }
            (Some(points), Some(table)) => Ok(Some(Mimda {
                importance: self.importance(points)?,
                gamma: self.within(&table.get_ref().gamma, 0.0..=1.0)?,
                form: table.get_ref().form.unwrap_or(MimdaForm::Consistent),
            })),
        }
    }

    /// Extinction over data values.
    pub(super) fn extinction(&self, points: &Points) -> Checked<Curve<f64>> {
        let curve = self.curve(points, |[extinction]| extinction)?;
        self.check_curve(points, |optics| optics.extinction.clone_from(&curve))?;
        Ok(curve)
    }

    /// Linear red, green and blue over data values.
    pub(super) fn colour(&self, points: &Points) -> Checked<Curve<DVec3>> {
        let curve = self.curve(points, DVec3::from_array)?;
        self.check_curve(points, |optics| optics.colour.clone_from(&curve))?;
        Ok(curve)
    }

    /// Importance over data values.
    pub(super) fn importance(&self, points: &Points) -> Checked<Curve<f64>> {
        self.refuse(points, |rest| rest[0] > 1.0, "an importance is above 1; importances lie in [0, 1]")?;
        self.curve(points, |[importance]| importance)
    }

    /// Refraction index over data values.
    pub(super) fn refraction(&self, points: &Points) -> Checked<Curve<f64>> {
        self.refuse(points, |rest| rest[0] <= 0.0, "a refraction index is not above 0; that of air is 1")?;
        let curve = self.curve(points, |[index]| index)?;
        self.check_curve(points, |optics| optics.refraction = Some(curve.clone()))?;
        Ok(curve)
    }

    fn materials(&self, points: &Points, has_light: bool) -> Checked<Curve<Material>> {
        if !has_light {
            return Err(self.wrong(points.span(), "they do nothing without a [light] table; add one"));
        }
        let is_too_dull = |rest: &[f64]| rest.get(3).is_some_and(|shininess| *shininess < 1.0);
        self.refuse(points, is_too_dull, "a shininess is below 1; give at least 1 as the last number")?;
        let material = |[ambient, diffuse, specular, shininess]: [f64; 4]| Material {
            ambient,
            diffuse,
            specular,
            shininess,
        };
        let curve = self.curve(points, material)?;
        self.check_curve(points, |optics| optics.materials = Some(curve.clone()))?;
        Ok(curve)
    }

    /// Refuses the control point that the renderer would refuse, whatever volume the curve meets.
    fn check_curve(&self, points: &Points, put: impl FnOnce(&mut Optics)) -> Checked<()> {
        let mut optics = Optics::grey(Curve::constant(1.0));
        put(&mut optics);
        let Err(error) = optics.check() else { return Ok(()) };
        let index = match error {
            OpticsError::TooLarge { index, .. }
            | OpticsError::Refraction { index, .. }
            | OpticsError::Shininess { index, .. }
            | OpticsError::Importance { index, .. } => Some(index),
            _ => None,
        };
        let point = index.and_then(|index| points.get_ref().get(index));
        Err(self.wrong(point.map_or(points.span(), Spanned::span), error.to_string()))
    }

    /// Refuses the first control point whose numbers after the data value are wrong; those are at least one.
    fn refuse(&self, points: &Points, is_wrong: impl Fn(&[f64]) -> bool, message: &str) -> Checked<()> {
        let mut places = points.get_ref().iter();
        let wrong = places
            .find(|point| point.get_ref().get(1..).is_some_and(|rest| !rest.is_empty() && is_wrong(rest)));
        wrong.map_or(Ok(()), |point| Err(self.wrong(point.span(), message)))
    }

    /// A curve over data values; each point has one number for the value and N for what it maps to.
    fn curve<V: CurveValue, const N: usize>(
        &self,
        points: &Points,
        make: fn([f64; N]) -> V,
    ) -> Checked<Curve<V>> {
        let mut pairs = Vec::with_capacity(points.get_ref().len());
        for point in points.get_ref() {
            let numbers = point.get_ref();
            let rest = numbers.get(1..).and_then(|rest| <[f64; N]>::try_from(rest).ok());
            let count = || format!("a point has {} numbers; give {}", numbers.len(), N + 1);
            pairs.push((numbers.first().copied(), rest.ok_or_else(|| self.wrong(point.span(), count()))?));
        }
        let pairs = pairs.into_iter().filter_map(|(value, rest)| Some((value?, make(rest)))).collect();
        Curve::new(pairs).map_err(|error| {
            let at = match error {
                CurveError::Empty => points.span(),
                CurveError::NotANumber { index } | CurveError::NotSorted { index } => {
                    points.get_ref()[index].span()
                }
            };
            self.wrong(at, error.to_string())
        })
    }
}
