// GGX reflection, height-correlated masking, Schlick's Fresnel term
// Source: walter2007 (2007). Written by Lesk 0.1.0.
//
// wi points to the light and wo to the viewer: unit vectors in the local frame, normal +z, tangent +x.
// ggx_eval: f(wi, wo) in 1/sr, without the cosine; 0 unless both lie above the surface.
//
// Parameters:
//   f0       0 to 1. Reflectance at normal incidence.
//   alpha_x  0.001 to 1. Width of the facet slopes along the tangent; 0.1 is satin, 0.5 is matte.
//   alpha_y  0.001 to 1. Width of the facet slopes across the tangent.

struct GgxParams {
    vec3 f0;
    float alpha_x;
    float alpha_y;
};

vec3 ggx_eval(vec3 wi, vec3 wo, GgxParams p) {
    if (wi.z < 1e-6 || wo.z < 1e-6) {
        return vec3(0.0);
    }
    vec3 h = wi + wo;
    float h_squared = dot(h, h);
    float cos_d = 0.5 * sqrt(max(h_squared, 1e-36));
    float t1 = 1.0 - min(cos_d, 1.0);
    float t1_squared = t1 * t1;
    vec3 v1 = vec3(h.x / p.alpha_x, h.y / p.alpha_y, h.z);
    float t2 = h_squared / dot(v1, v1);
    float d = t2 * t2 / (3.1415927 * p.alpha_x * p.alpha_y);
    float t3 = wi.z * length(vec3(p.alpha_x * wo.x, p.alpha_y * wo.y, wo.z));
    float v = 0.5 / (wo.z * length(vec3(p.alpha_x * wi.x, p.alpha_y * wi.y, wi.z)) + t3);
    return mix(p.f0, vec3(1.0), t1 * (t1_squared * t1_squared)) * (d * v);
}
