// Anisotropic GGX reflection with height-correlated masking, written from the equations: walter2007 Eq. 33 in its
// anisotropic form, heitz2014 Eq. 99, schlick1994.

struct Ggx {
    vec3 f0;
    float alpha_x;
    float alpha_y;
};

float ggx_d(vec3 h, float alpha_x, float alpha_y) {
    vec3 s = vec3(h.x / alpha_x, h.y / alpha_y, h.z);
    float e = dot(s, s);
    return 1.0 / (3.14159265 * alpha_x * alpha_y * e * e);
}

float ggx_stretch(vec3 w, float alpha_x, float alpha_y) {
    return length(vec3(alpha_x * w.x, alpha_y * w.y, w.z));
}

float ggx_v(vec3 wi, vec3 wo, float alpha_x, float alpha_y) {
    return 0.5 / (wo.z * ggx_stretch(wi, alpha_x, alpha_y) + wi.z * ggx_stretch(wo, alpha_x, alpha_y));
}

vec3 schlick(vec3 f0, float cos_theta) {
    float m = 1.0 - cos_theta;
    float m2 = m * m;
    return f0 + (1.0 - f0) * (m2 * m2 * m);
}

vec3 ggx_by_hand(vec3 wi, vec3 wo, Ggx p) {
    if (wi.z <= 0.0 || wo.z <= 0.0) {
        return vec3(0.0);
    }
    vec3 h = normalize(wi + wo);
    return schlick(p.f0, dot(wi, h)) * (ggx_d(h, p.alpha_x, p.alpha_y) * ggx_v(wi, wo, p.alpha_x, p.alpha_y));
}
