/// The normal on the viewer's side, of any length: the octahedral map does not care. Winding and stored normals of real models disagree too often to trust either alone:
/// the true face, from derivatives, decides the side; surfaces are two-sided.
/// `slack` (0..1): a normal is turned only if its cosine with the face is less than minus this.
vec3 facing_normal(vec3 shading_normal, vec3 from_eye, float slack) {
    vec3 face = cross(dFdx(from_eye), dFdy(from_eye));
    face *= dot(face, from_eye) > 0.0 ? -1.0 : 1.0;
    float limit = slack > 0.0 ? -slack * length(face) * length(shading_normal) : 0.0;
    return dot(shading_normal, face) < limit ? -shading_normal : shading_normal;
}
