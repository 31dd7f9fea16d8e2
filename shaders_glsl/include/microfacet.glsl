// Reflection by GGX, the counterpart of `daylight::microfacet` on the CPU; there are the sources. Needs constants.glsl, materials.glsl.

// Whether the scene has materials that reflect by GGX, set by every pipeline that shows radiance; otherwise any image is bound.
layout(constant_id = 42) const bool ROUGH = false;
// Factor on what their lobes reflect.
layout(constant_id = 43) const float LOBE_SCALE = 1.0;

// Reflectance of a lobe under uniform light by the parts of F0 and of F90, over sqrt(n.v) and the roughness: columns and rows of a
// table, in one row after the other behind the materials. A texel has the two values of its column and those of the next.
const vec2 LOBE_TABLE = vec2(64.0, 32.0);

// Least alpha of the lobe of a source as wide as the sun.
layout(constant_id = 44) const float LEAST_ALPHA = 0.0;

// Least cosine between normal and eye: normals of maps may be turned away.
const float LEAST_FACING = 1e-3;

struct Microfacet {
    vec3 diffuse;     // rho_d, without what the lobe reflects before it
    vec3 f0;          // reflectance at normal incidence
    float f90;        // at grazing incidence
    float roughness;
    float alpha;
    vec3 gain;        // factor on a single reflection
    vec3 reflectance; // of the lobe under uniform light, toward the eye
};

vec4 lobe_texel(sampler2D materials, vec2 at) {
    float columns = float(MATERIAL_COLUMNS), number = at.y * LOBE_TABLE.x + at.x;
    float first = float(textureSize(materials, 0).y) - ceil(LOBE_TABLE.x * LOBE_TABLE.y / columns);
    return texel_at(materials, vec2(mod(number, columns), first + floor(number / columns)));
}

vec2 lobe_albedo(sampler2D materials, float facing, float roughness) {
    vec2 at = clamp(vec2(sqrt(max(facing, LEAST_FACING)), roughness), 0.0, 1.0) * (LOBE_TABLE - 1.0);
    vec2 low = min(floor(at), LOBE_TABLE - 2.0), between = at - low;
    vec4 pair = mix(lobe_texel(materials, low), lobe_texel(materials, low + vec2(0.0, 1.0)), between.y);
    return mix(pair.rg, pair.ba, between.x);
}

bool is_rough(vec4 specular) {
    return ROUGH && specular.a < 0.0;
}

/// The surface of a pixel. `texel`: from `pixel_albedo`; `facing`: cosine between normal and eye.
Microfacet microfacet_of(bool from_image, vec4 texel, sampler2D materials, uint word, float facing) {
    float f90 = material_row(materials, word, 0u).a;
    vec4 specular = material_row(materials, word, 1u);
    float metallic = from_image ? texel.a : material_row(materials, word, 2u).a;
    Microfacet m;
    m.diffuse = texel.rgb * (1.0 - metallic);
    m.f0 = mix(specular.rgb, texel.rgb, metallic);
    m.f90 = mix(f90, 1.0, metallic);
    m.roughness = (-1.0 - specular.a) * roughness_factor(word);
    m.alpha = m.roughness * m.roughness;
    vec2 parts = lobe_albedo(materials, facing, m.roughness);
    m.gain = 1.0 + m.f0 * (1.0 / (parts.x + parts.y) - 1.0);
    m.reflectance = LOBE_SCALE * m.gain * (m.f0 * parts.x + m.f90 * parts.y);
    return m;
}

/// rho_d under the lobe: what the lobe reflects does not reach it.
vec3 under_lobe(Microfacet m) {
    return m.diffuse * (1.0 - min(m.reflectance, 1.0));
}

/// rho_d of a pixel toward the eye, of materials of either kind.
vec3 pixel_diffuse(bool from_image, vec4 texel, sampler2D materials, uint word, float facing) {
    if (!is_rough(material_specular(materials, word))) return texel.rgb;
    return under_lobe(microfacet_of(from_image, texel, materials, word, facing));
}

vec3 schlick(Microfacet m, float along) {
    float off = clamp(1.0 - along, 0.0, 1.0);
    float off2 = off * off;
    return m.f0 + (m.f90 - m.f0) * (off2 * off2 * off);
}

/// Smith's Lambda of a direction at a cosine from the normal.
float smith(float alpha, float cosine) {
    float cos2 = max(cosine * cosine, 1e-12);
    return 0.5 * (sqrt(1.0 + alpha * alpha * max(1.0 - cos2, 0.0) / cos2) - 1.0);
}

/// f(v, l) (n.l) toward a source as wide as the sun.
vec3 lobe_toward(Microfacet m, vec3 n, vec3 v, vec3 l) {
    float from = max(dot(n, v), LEAST_FACING), to = dot(n, l);
    if (to <= 0.0) return vec3(0.0);
    vec3 h = normalize(v + l);
    float alpha = max(m.alpha, LEAST_ALPHA), a2 = alpha * alpha;
    // By the sine: the cosines of narrow lobes have no precision in float32.
    vec3 across = cross(n, h);
    float sin2 = min(dot(across, across), 1.0);
    float base = a2 * (1.0 - sin2) + sin2;
    float distribution = a2 / (PI * base * base);
    float seen = 1.0 / (1.0 + smith(alpha, from) + smith(alpha, to));
    return LOBE_SCALE * m.gain * schlick(m, dot(v, h)) * (distribution * seen / (4.0 * from));
}

/// A normal with the density of those seen from v, both about +z, for xi in [0, 1)^2.
vec3 visible_normal(float alpha, vec3 v, vec2 xi) {
    vec3 stretch = vec3(alpha, alpha, 1.0);
    vec3 seen = normalize(v * stretch);
    float z = (1.0 - xi.y) * (1.0 + seen.z) - seen.z, phi = 2.0 * PI * xi.x;
    float sine = sqrt(max(1.0 - z * z, 0.0));
    vec3 h = (vec3(sine * cos(phi), sine * sin(phi), z) + seen) * stretch;
    return normalize(vec3(h.xy, max(h.z, 1e-7)));
}

/// f(v, l) (n.l) over the density of l by `visible_normal`; the cosines are those of eye and light to the normal, and of the eye to h.
vec3 lobe_weight(Microfacet m, float from, float to, float along) {
    float lambda = smith(m.alpha, from);
    float seen = (1.0 + lambda) / (1.0 + lambda + smith(m.alpha, to));
    return LOBE_SCALE * m.gain * schlick(m, along) * seen;
}
