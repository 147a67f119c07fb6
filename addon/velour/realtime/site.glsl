// What a pixel knows of its surface, and the lamps that light it.

struct Site {
  vec3 view, normal;        // towards the viewer
  vec2 place;               // texture coordinates
  vec3 along_u, along_v;    // where these grow, not normalised
  bool is_behind;           // seen from where the surface's normal does not point to
  bool is_holed;            // of a BTF, whose values are means with the holes of its structure
  vec2 beyond;              // HoledBtfMaterial: from there to its mirror image beyond an outline; 0: none is near
};

// Towards the viewer.
vec3 view_from_here() { return eye.w > 0.0 ? normalize(eye.xyz - world) : eye.xyz; }

// Interpolated normals may face away at an outline.
vec3 facing(vec3 n, vec3 view)
{
  float cosine = dot(n, view);
  return cosine < 0.01 ? normalize(n + (0.01 - cosine) * view) : n;
}

vec3 normal_towards(vec3 view, out bool is_behind)
{
  vec3 flat_normal = normalize(cross(dFdx(world), dFdy(world)));
  if (dot(flat_normal, view) < 0.0) flat_normal = -flat_normal;
  bool is_flat = dot(shading_normal, shading_normal) == 0.0;
  vec3 n = is_flat ? flat_normal : normalize(shading_normal);
  // A mirrored triangle goes round the other way.
  is_behind = is_flat ? gl_FrontFacing == (handed < 0.0) : dot(n, flat_normal) < 0.0;
  if (dot(n, flat_normal) < 0.0) n = -n;
  return facing(n, view);
}

// Where texture coordinates grow on the surface, not normalised: along u, and along v.
void tangents(out vec3 along_u, out vec3 along_v)
{
  vec3 px = dFdx(world), py = dFdy(world);
  vec2 tx = dFdx(coordinates), ty = dFdy(coordinates);
  float turn = sign(tx.x * ty.y - tx.y * ty.x);
  along_u = turn * (px * ty.y - py * tx.y);
  along_v = turn * (py * tx.x - px * ty.x);
}

// About n, x as `along` as it can be.
mat3 frame_about(vec3 n, vec3 along)
{
  vec3 x = along - dot(along, n) * n;
  if (dot(x, x) < 1e-20) x = abs(n.x) < 0.9 ? vec3(1, 0, 0) - n.x * n : vec3(0, 1, 0) - n.y * n;
  x = normalize(x);
  return mat3(x, cross(n, x), n);
}

// Irradiance of a plane that faces the lamp; `light`: unit, towards it; `bandwidth`: of what is seen of it.
// Four pixels a lamp: place or direction, kind; colour, radius squared; axis, cosine of a spot's cone; its blend.
vec3 lamp_light(int lamp, out vec3 light, out float bandwidth)
{
  vec4 where = texelFetch(lamps, ivec2(4 * lamp, 0), 0), color = texelFetch(lamps, ivec2(4 * lamp + 1, 0), 0);
  vec4 axis = texelFetch(lamps, ivec2(4 * lamp + 2, 0), 0), more = texelFetch(lamps, ivec2(4 * lamp + 3, 0), 0);
  if (where.w == 0.0) {
    light = where.xyz;
    bandwidth = 4.0 / max(color.w, 1e-6);
    return color.rgb;
  }
  vec3 path = where.xyz - world;
  float square = max(dot(path, path), 1e-8);
  light = path * inversesqrt(square);
  bandwidth = 4.0 * square / max(color.w, 1e-6 * square);
  float leaves = dot(-light, axis.xyz);
  float share = where.w == 2.0 ? max(leaves, 0.0) : where.w == 3.0 ? smoothstep(0.0, 1.0, (leaves - axis.w) / max(more.x, 1e-6)) : 1.0;
  return color.rgb * share / square;
}
