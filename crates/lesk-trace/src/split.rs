//! Kinds of light paths, after Ritschel et al., *The State of the Art in Interactive Global Illumination*, 2012.

/// Number of kinds.
pub(crate) const SPLITS: usize = 4;

/// The names of the layers, in the order of their numbers. Their sum is the picture.
pub const SPLIT_NAMES: [&str; SPLITS] = ["direct", "indirect", "specular", "caustic"];

/// What a path has met so far, from the camera. Specular means delta lobes: a rough surface is not specular.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PathKind {
    /// Nothing: lights seen themselves count as direct.
    Camera,
    /// One rough surface: direct light.
    Direct,
    /// A mirror or a glass pane first.
    Specular,
    /// A rough surface, then only delta lobes: the light was focused onto it.
    Caustic,
    /// Anything longer.
    Indirect,
}

impl PathKind {
    pub(crate) fn camera() -> PathKind {
        PathKind::Camera
    }

    /// One more scattering event; `delta` if by a delta lobe.
    pub(crate) fn then(self, delta: bool) -> PathKind {
        match (self, delta) {
            (PathKind::Camera, false) => PathKind::Direct,
            (PathKind::Camera | PathKind::Specular, true) | (PathKind::Specular, false) => PathKind::Specular,
            (PathKind::Direct | PathKind::Caustic, true) => PathKind::Caustic,
            (PathKind::Direct | PathKind::Caustic | PathKind::Indirect, false) | (PathKind::Indirect, true) => {
                PathKind::Indirect
            }
        }
    }

    /// The number of the layer.
    pub(crate) fn split(self) -> usize {
        match self {
            PathKind::Camera | PathKind::Direct => 0,
            PathKind::Indirect => 1,
            PathKind::Specular => 2,
            PathKind::Caustic => 3,
        }
    }
}
