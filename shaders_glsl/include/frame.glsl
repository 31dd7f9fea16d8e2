// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
// The lecture's frame (Frisvad 2012) divides by 1 + n.z: in float32 its error reaches 0.15 near n = -z; here it stays at 1e-7.

/// Right-handed orthonormal frame whose third column is n.
mat3 frame_from_normal(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    vec3 t = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    vec3 u = vec3(b, s + n.y * n.y * a, -n.y);
    return mat3(t, u, n);
}
