//! Affine transforms, kept with their inverse.

use crate::error::{Error, Result};
use lesk_math::{Vec3, vec3};

/// Three rows of four: the linear part and, in the last column, the translation.
pub type Rows = [[f64; 4]; 3];

/// An affine map from local to world space together with its inverse, in f64.
///
/// Points of f32 are transformed in f64 and rounded once.
///
/// ```
/// use lesk_geometry::Transform;
/// use lesk_math::vec3;
/// let lift = Transform::translate(0.0, 0.0, 2.0) * Transform::rotate_z(std::f64::consts::FRAC_PI_2);
/// let p = lift.point(vec3(1.0, 0.0, 0.0));
/// assert!((p - vec3(0.0, 1.0, 2.0)).length() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    forward: Rows,
    inverse: Rows,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// Leaves every point where it is.
    pub const IDENTITY: Self = {
        let rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        Transform { forward: rows, inverse: rows }
    };

    /// The transform with the given rows.
    ///
    /// # Errors
    /// Entries that are not finite, and matrices that flatten space: those whose inverse would lose all digits of an
    /// f32 (condition number above 1e10).
    pub fn from_rows(rows: Rows) -> Result<Self> {
        if rows.iter().flatten().any(|x| !x.is_finite()) {
            return Err(Error::new(format!("transform has an entry that is not finite: {rows:?}")));
        }
        let inverse = invert(&rows);
        let condition = norm(&rows) * norm(&inverse);
        if condition.is_nan() || condition > 1e10 || inverse.iter().flatten().any(|x| !x.is_finite()) {
            return Err(Error::new(format!(
                "transform cannot be inverted: its condition number is {condition:e}, at most 1e10 is accepted"
            ))
            .hint("a scale of zero along some axis flattens a shape; use a small one instead"));
        }
        Ok(Transform { forward: rows, inverse })
    }

    /// From the sixteen numbers of a column-major 4x4 matrix (glTF); the last row must be 0, 0, 0, 1.
    ///
    /// # Errors
    /// As [`from_rows`](Self::from_rows), and for a projective last row.
    pub fn from_columns(m: &[f64; 16]) -> Result<Self> {
        let last = [m[3], m[7], m[11], m[15]];
        if last != [0.0, 0.0, 0.0, 1.0] {
            return Err(Error::new(format!("transform has the last row {last:?}, an affine one has [0, 0, 0, 1]")));
        }
        Self::from_rows(std::array::from_fn(|r| std::array::from_fn(|c| m[4 * c + r])))
    }

    /// Moves by (x, y, z) metres. Not finite input gives a transform that moves nothing.
    pub fn translate(x: f64, y: f64, z: f64) -> Self {
        let at = |t: [f64; 3]| {
            let mut rows = Self::IDENTITY.forward;
            for r in 0..3 {
                rows[r][3] = t[r];
            }
            rows
        };
        if !(x + y + z).is_finite() {
            return Self::IDENTITY;
        }
        Transform { forward: at([x, y, z]), inverse: at([-x, -y, -z]) }
    }

    /// Scales by the given factors along the axes; a negative one mirrors.
    ///
    /// # Errors
    /// A factor of zero or one that is not finite.
    pub fn scale(x: f64, y: f64, z: f64) -> Result<Self> {
        Self::from_rows([[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]])
    }

    /// Rotates about `axis` by `angle` radians, counter-clockwise seen against the axis.
    ///
    /// # Errors
    /// An axis of length zero, or input that is not finite.
    pub fn rotate(axis: Vec3<f64>, angle: f64) -> Result<Self> {
        let length = axis.length();
        if !(length.is_finite() && length > 1e-150 && angle.is_finite()) {
            return Err(Error::new(format!(
                "rotation has the axis {:?} and the angle {angle}, the axis must have a length and both be finite",
                axis.to_array()
            )));
        }
        Ok(Self::rotation(axis / length, angle))
    }

    /// Rotates about +x by `angle` radians.
    pub fn rotate_x(angle: f64) -> Self {
        Self::rotation(vec3(1.0, 0.0, 0.0), angle)
    }

    /// Rotates about +y by `angle` radians.
    pub fn rotate_y(angle: f64) -> Self {
        Self::rotation(vec3(0.0, 1.0, 0.0), angle)
    }

    /// Rotates about +z by `angle` radians.
    pub fn rotate_z(angle: f64) -> Self {
        Self::rotation(vec3(0.0, 0.0, 1.0), angle)
    }

    /// Rodrigues' formula for a unit axis.
    fn rotation(axis: Vec3<f64>, angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        let a = axis.to_array();
        let cross = [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]];
        let mut rows = Self::IDENTITY.forward;
        for i in 0..3 {
            for j in 0..3 {
                let same = if i == j { c } else { 0.0 };
                rows[i][j] = same + (1.0 - c) * a[i] * a[j] + s * cross[i][j];
            }
        }
        let mut inverse = rows;
        for i in 0..3 {
            for j in 0..3 {
                inverse[i][j] = rows[j][i];
            }
        }
        Transform { forward: rows, inverse }
    }

    /// Places a camera: local -z looks from `eye` to `target`, local +y is as near to `up` as can be, +x is right.
    ///
    /// # Errors
    /// `eye` equal to `target`, or `up` parallel to the view.
    pub fn look_at(eye: Vec3<f64>, target: Vec3<f64>, up: Vec3<f64>) -> Result<Self> {
        let back = eye - target;
        let right = up.cross(back);
        if !(right.length() > 1e-9 * up.length() * back.length() && right.length().is_finite()) {
            return Err(Error::new(format!(
                "camera looks from {:?} to {:?} with up {:?}, which gives no direction to the right",
                eye.to_array(),
                target.to_array(),
                up.to_array()
            ))
            .hint("eye and target must differ, and `up` must not be parallel to the view"));
        }
        let (x, z) = (right / right.length(), back / back.length());
        let y = z.cross(x);
        Self::from_rows([[x.x, y.x, z.x, eye.x], [x.y, y.y, z.y, eye.y], [x.z, y.z, z.z, eye.z]])
    }

    /// The map back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Transform { forward: self.inverse, inverse: self.forward }
    }

    /// The rows of the map.
    pub fn rows(&self) -> &Rows {
        &self.forward
    }

    /// The rows of the inverse map.
    pub fn inverse_rows(&self) -> &Rows {
        &self.inverse
    }

    /// Determinant of the linear part: the factor of volumes, negative for a mirror.
    pub fn determinant(&self) -> f64 {
        determinant(&self.forward)
    }

    /// The common factor of all lengths where the map keeps angles (within 1e-6), else `None`.
    pub fn uniform_scale(&self) -> Option<f64> {
        let c = |j: usize| vec3(self.forward[0][j], self.forward[1][j], self.forward[2][j]);
        let s = self.determinant().abs().cbrt();
        let near = |x: f64, y: f64| (x - y).abs() <= 1e-6 * s * s;
        let lengths = (0..3).all(|j| near(c(j).dot(c(j)), s * s));
        let angles = (0..3).all(|j| near(c(j).dot(c((j + 1) % 3)), 0.0));
        (lengths && angles).then_some(s)
    }

    /// Where the point goes, in f64.
    #[inline]
    pub fn point_f64(&self, p: Vec3<f64>) -> Vec3<f64> {
        let row = |r: &[f64; 4]| r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
        let m = &self.forward;
        vec3(row(&m[0]), row(&m[1]), row(&m[2]))
    }

    /// Where the vector goes, in f64 (translations do not move it).
    #[inline]
    pub fn vector_f64(&self, v: Vec3<f64>) -> Vec3<f64> {
        let row = |r: &[f64; 4]| r[0] * v.x + r[1] * v.y + r[2] * v.z;
        let m = &self.forward;
        vec3(row(&m[0]), row(&m[1]), row(&m[2]))
    }

    /// Where the normal goes, in f64, not normalised: the transposed inverse.
    /// A mirror keeps outward normals outward.
    #[inline]
    pub fn normal_f64(&self, n: Vec3<f64>) -> Vec3<f64> {
        let m = &self.inverse;
        let column = |j: usize| m[0][j] * n.x + m[1][j] * n.y + m[2][j] * n.z;
        vec3(column(0), column(1), column(2))
    }

    /// Where the point goes; computed in f64, rounded once.
    #[inline]
    pub fn point(&self, p: Vec3<f32>) -> Vec3<f32> {
        narrow(self.point_f64(widen(p)))
    }

    /// Where the vector goes; computed in f64, rounded once.
    #[inline]
    pub fn vector(&self, v: Vec3<f32>) -> Vec3<f32> {
        narrow(self.vector_f64(widen(v)))
    }

    /// Where the normal goes, unit length.
    #[inline]
    pub fn normal(&self, n: Vec3<f32>) -> Vec3<f32> {
        narrow(self.normal_f64(widen(n)).normalize())
    }

    /// By how much a small area with the local unit normal `n` grows.
    #[inline]
    pub fn area_factor(&self, n: Vec3<f64>) -> f64 {
        self.determinant().abs() * self.normal_f64(n).length()
    }
}

impl std::ops::Mul for Transform {
    type Output = Self;

    /// `(a * b)` applies `b` first.
    fn mul(self, o: Self) -> Self {
        Transform { forward: compose(&self.forward, &o.forward), inverse: compose(&o.inverse, &self.inverse) }
    }
}

/// The f64 copy of an f32 vector.
#[inline(always)]
pub(crate) fn widen(v: Vec3<f32>) -> Vec3<f64> {
    vec3(v.x as f64, v.y as f64, v.z as f64)
}

/// The nearest f32 vector.
#[inline(always)]
pub(crate) fn narrow(v: Vec3<f64>) -> Vec3<f32> {
    vec3(v.x as f32, v.y as f32, v.z as f32)
}

fn compose(a: &Rows, b: &Rows) -> Rows {
    std::array::from_fn(|r| {
        std::array::from_fn(|c| {
            let moved = if c == 3 { a[r][3] } else { 0.0 };
            (0..3).map(|k| a[r][k] * b[k][c]).sum::<f64>() + moved
        })
    })
}

fn cofactor(m: &Rows, r: usize, c: usize) -> f64 {
    let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
    m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
}

fn determinant(m: &Rows) -> f64 {
    (0..3).map(|c| m[0][c] * cofactor(m, 0, c)).sum()
}

fn invert(m: &Rows) -> Rows {
    let d = determinant(m);
    let mut out = [[0.0; 4]; 3];
    for r in 0..3 {
        for c in 0..3 {
            out[r][c] = cofactor(m, c, r) / d;
        }
        out[r][3] = -(0..3).map(|k| out[r][k] * m[k][3]).sum::<f64>();
    }
    out
}

/// Frobenius norm of the linear part.
fn norm(m: &Rows) -> f64 {
    m.iter().map(|r| r[..3].iter().map(|x| x * x).sum::<f64>()).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Vec3<f64>, b: Vec3<f64>, tolerance: f64) {
        assert!((a - b).length() <= tolerance, "{a:?} is not {b:?}");
    }

    fn awkward() -> Transform {
        Transform::translate(3.0, -2.0, 1.0)
            * Transform::rotate(vec3(1.0, 2.0, -0.5), 0.7).unwrap()
            * Transform::scale(2.0, 0.3, -1.5).unwrap()
    }

    #[test]
    fn the_inverse_undoes_the_transform() {
        let t = awkward();
        let p = vec3(0.3, 7.0, -4.0);
        // 1e-13: about 100 f64 roundings of numbers near 10
        close(t.inverse().point_f64(t.point_f64(p)), p, 1e-13);
        close((t.inverse() * t).point_f64(p), p, 1e-13);
    }

    #[test]
    fn composition_applies_the_right_factor_first() {
        let (a, b) = (Transform::translate(1.0, 0.0, 0.0), Transform::rotate_z(std::f64::consts::FRAC_PI_2));
        close((a * b).point_f64(vec3(1.0, 0.0, 0.0)), vec3(1.0, 1.0, 0.0), 1e-15);
        close((b * a).point_f64(vec3(1.0, 0.0, 0.0)), vec3(0.0, 2.0, 0.0), 1e-15);
    }

    #[test]
    fn normals_stay_perpendicular_to_transformed_tangents() {
        let t = awkward();
        let (u, v) = (vec3(1.0, 0.2, 0.0), vec3(-0.3, 1.0, 0.8));
        let n = t.normal_f64(u.cross(v));
        assert!(n.dot(t.vector_f64(u)).abs() < 1e-12 && n.dot(t.vector_f64(v)).abs() < 1e-12);
    }

    #[test]
    fn area_factor_is_the_length_of_the_transformed_cross_product() {
        let t = awkward();
        let (u, v) = (vec3(1.0, 0.2, 0.0), vec3(-0.3, 1.0, 0.8));
        let n = u.cross(v);
        let expected = t.vector_f64(u).cross(t.vector_f64(v)).length() / n.length();
        assert!((t.area_factor(n / n.length()) - expected).abs() < 1e-12 * expected);
    }

    #[test]
    fn look_at_sends_minus_z_to_the_target_and_y_upward() {
        let t = Transform::look_at(vec3(0.0, -5.0, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0)).unwrap();
        close(t.vector_f64(vec3(0.0, 0.0, -1.0)), vec3(0.0, 1.0, 0.0), 1e-15);
        close(t.vector_f64(vec3(0.0, 1.0, 0.0)), vec3(0.0, 0.0, 1.0), 1e-15);
        close(t.vector_f64(vec3(1.0, 0.0, 0.0)), vec3(1.0, 0.0, 0.0), 1e-15);
        close(t.point_f64(Vec3::ZERO), vec3(0.0, -5.0, 1.0), 0.0);
    }

    #[test]
    fn uniform_scale_is_found_through_rotation_and_mirror() {
        let t = Transform::rotate_x(0.4) * Transform::scale(-2.5, 2.5, 2.5).unwrap();
        assert!((t.uniform_scale().unwrap() - 2.5).abs() < 1e-12);
        assert_eq!(Transform::scale(1.0, 1.0, 1.01).unwrap().uniform_scale(), None);
    }

    #[test]
    fn flattening_and_infinite_transforms_are_refused() {
        let flat = Transform::scale(1.0, 0.0, 1.0).unwrap_err().to_string();
        assert!(flat.contains("cannot be inverted") && flat.contains("hint:"), "{flat}");
        assert!(Transform::scale(f64::NAN, 1.0, 1.0).is_err());
        assert!(Transform::rotate(Vec3::ZERO, 1.0).is_err());
        let eye = vec3(1.0, 1.0, 1.0);
        assert!(Transform::look_at(eye, eye, Vec3::Z).is_err());
        assert!(Transform::look_at(Vec3::ZERO, Vec3::Z, Vec3::Z).is_err());
        let mut projective = [0.0; 16];
        projective[11] = -1.0;
        assert!(Transform::from_columns(&projective).is_err());
    }
}
