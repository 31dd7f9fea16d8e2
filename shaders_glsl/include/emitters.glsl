// Direct light of surfaces that emit: points on them, chosen by power. Both these points and rays in the directions of cosines find
// emitters; the balance heuristic (Veach and Guibas 1995) weights the two, so that nothing counts twice. Needs surface_hit.glsl,
// scene_light.glsl. `scene::emitters` is the counterpart on the CPU.

// Whether any triangle emits light, and columns of their table.
layout(constant_id = 34) const bool EMITS = false;
layout(constant_id = 35) const uint EMITTER_COLUMNS = 1u;

// Number of emitters, and the sum of their areas times luminance, kcd; then for each: position in the image of triangles; power of this and all
// earlier emitters as a fraction of all. The number is no uniform: lavapipe would compile the loop below anew for each.
layout(set = 0, binding = 25) uniform usampler2D emitters;

uvec4 emitter_row(uint row) {
    return texel_at(emitters, vec2(row % EMITTER_COLUMNS, row / EMITTER_COLUMNS));
}

uvec4 emitter_texel(uint i) {
    return emitter_row(i + 1u);
}

float emitter_up_to(uint i) {
    return uintBitsToFloat(emitter_texel(i).y);
}

/// Density of directions toward points on a surface with this emission, per steradian. `toward`: from the receiver; `normal`: of the
/// emitter.
float emitter_density(vec3 emission, vec3 normal, vec3 toward, float distance) {
    float emitted = uintBitsToFloat(emitter_row(0u).y);
    return luminance(emission) / emitted * distance * distance / max(abs(dot(normal, toward)), 1e-6);
}

/// Irradiance of the light that a surface emits, klx, found by a ray in a direction of density cosine / pi.
vec3 emission_of_ray(Surface surface, float cosine, vec3 toward, float distance) {
    if (!EMITS || surface.emission == vec3(0.0)) return vec3(0.0);
    float by_ray = cosine / PI;
    float weight = by_ray / (by_ray + emitter_density(surface.emission, surface.normal, toward, distance));
    return PI * weight * surface.emission;
}

/// The emitter for a number in [0, 1), which is replaced by another one.
uint choose_emitter(inout float xi) {
    uint low = 0u, high = emitter_row(0u).x - 1u;
    // Bisection; a table of 2^32 texels takes 32 steps.
    for (int i = 0; i < 32 && low < high; ++i) {
        uint middle = (low + high) / 2u;
        if (emitter_up_to(middle) <= xi) low = middle + 1u;
        else high = middle;
    }
    float from = low > 0u ? emitter_up_to(low - 1u) : 0.0, up_to = emitter_up_to(low);
    xi = up_to > from ? clamp((xi - from) / (up_to - from), 0.0, 1.0) : 0.5;
    return emitter_texel(low).x;
}

/// Irradiance of the light of an emitter on a point, klx, for xi in [0, 1)^2. `n`: its normal, about which rays have the density of
/// cosines; `face`: directions below it bring nothing.
vec3 emission_of_point(vec3 position, vec3 n, vec3 face, vec2 xi) {
    if (!EMITS) return vec3(0.0);
    uint triangle = choose_emitter(xi.x);
    uvec4 first = triangle_texel(triangle, 0u), second = triangle_texel(triangle, 1u), third = triangle_texel(triangle, 2u);
    vec3 edge1 = uintBitsToFloat(second.xyz), edge2 = uintBitsToFloat(third.xyz);
    vec3 emission = shared_exponent_unpack(second.w);
    float root = sqrt(xi.x);
    vec3 target = uintBitsToFloat(first.xyz) + root * (1.0 - xi.y) * edge1 + root * xi.y * edge2;
    vec3 normal = normalize(cross(edge1, edge2));
    if (dot(normal, position - target) < 0.0) normal = -normal;
    vec3 way = lifted(target, normal) - position;
    float distance = length(way);
    vec3 toward = way / max(distance, TINY);
    float cosine = dot(n, toward);
    if (cosine <= 0.0 || dot(face, toward) <= 0.0 || luminance(emission) == 0.0 || -dot(normal, toward) <= 1e-6) return vec3(0.0);
    if (any_hit(position, toward, distance)) return vec3(0.0);
    float opacity = float(third.w & OPACITY) / 255.0;
    float density = emitter_density(emission, normal, toward, distance) + cosine / PI;
    return emission * (opacity * cosine / density);
}
