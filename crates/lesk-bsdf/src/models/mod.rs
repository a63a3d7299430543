//! THE LIST: one line per model, in reading order; the name is the file, the id and the page.

crate::registry::registry! {
    lambert: Lambert,
    mirror: Mirror,
    conductor: Conductor,
    dielectric: Dielectric,
    phong: Phong,
    blinn_phong: BlinnPhong,
    modified_phong: ModifiedPhong,
    ward: Ward,
    oren_nayar: OrenNayar,
    cook_torrance: CookTorrance,
    ggx: Ggx,
    ggx_conductor: GgxConductor,
    ggx_conductor_separable: GgxConductorSeparable,
    rough_dielectric: RoughDielectric,
    disney_2012: Disney2012,
    metallic_roughness: MetallicRoughness,
}
