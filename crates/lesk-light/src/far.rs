//! Points of rectangles that shine, seen so small that they are chosen by area, for several receivers side by side.

use crate::area::Area;
use crate::rectangle::{Rectangle, point};
use crate::triangle::area_pdf;
use lesk_geometry::surfaces::{Row, SURFACES, VectorRows, set_vector, vector};
use lesk_math::{CHANNELS, Isa, Vec3, for_isa};

/// One rectangle for each of a group of receivers, then a point of each: the fields of a
/// [`LightSample`](crate::LightSample) in one array per number.
#[derive(Clone, Debug, Default)]
pub struct FarRectangles {
    receiver: VectorRows,
    corners: [VectorRows; 4],
    two_sided: [u32; SURFACES],
    area: Row,
    /// The probability of the rectangle among all lights.
    pmf: Row,
    u: [Row; 2],
    /// Unit normal of the rectangle, to the outside.
    pub n: VectorRows,
    /// How far a ray must keep from it, metres.
    pub lift: Row,
    /// Luminance, cd/m², by channel.
    pub value: [Row; CHANNELS],
    /// The point, metres.
    pub p: VectorRows,
    /// Unit direction to it.
    pub wi: VectorRows,
    /// Density of that direction in 1/sr, with the probability of the light; 0 where no light arrives.
    pub pdf: Row,
}

impl FarRectangles {
    /// Notes the rectangle of the receiver with number `i`.
    #[inline]
    pub(crate) fn note(&mut self, i: usize, x: Vec3<f32>, rectangle: &Rectangle, area: &Area, pmf: f32, u: [f32; 2]) {
        set_vector(&mut self.receiver, i, x);
        for (rows, corner) in self.corners.iter_mut().zip(rectangle.corners()) {
            set_vector(rows, i, *corner);
        }
        set_vector(&mut self.n, i, rectangle.normal());
        for (row, value) in self.value.iter_mut().zip(area.luminance().0) {
            row[i] = value;
        }
        self.two_sided[i] = area.two_sided().into();
        self.area[i] = rectangle.area();
        self.lift[i] = rectangle.lift();
        self.pmf[i] = pmf;
        (self.u[0][i], self.u[1][i]) = (u[0], u[1]);
    }

    /// Chooses the points.
    ///
    /// # Panics
    /// If this processor lacks `isa`.
    pub fn sample(&mut self, isa: Isa) {
        let this = self;
        for_isa!(isa, FarRectangles::sample_lanes, this: &mut FarRectangles);
    }

    /// Without branches, so that the loop is vectorised.
    #[inline(always)]
    fn sample_lanes(&mut self) {
        for i in 0..SURFACES {
            let x = vector(&self.receiver, i);
            let [c, a, b, d] = &self.corners;
            let corners = [vector(c, i), vector(a, i), vector(b, i), vector(d, i)];
            let (p, _) = point(corners, [self.u[0][i], self.u[1][i]]);
            let n = vector(&self.n, i);
            let to = p - x;
            let distance = to.length();
            let wi = to * (1.0 / distance);
            let shines = (self.two_sided[i] != 0) | (n.dot(wi) < 0.0);
            let pdf = area_pdf(x, p, n, self.area[i]) * self.pmf[i];
            // infinity and NaN fail the comparisons
            let arrives = shines & (distance > 1e-18) & (distance <= f32::MAX) & (pdf <= f32::MAX);
            set_vector(&mut self.p, i, p);
            set_vector(&mut self.wi, i, wi);
            self.pdf[i] = if arrives { pdf } else { 0.0 };
        }
    }
}
