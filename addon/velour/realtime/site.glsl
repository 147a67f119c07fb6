// A pixel's surface point, and the lights that illuminate it.

struct Site {
  vec3 view, normal;        // towards the viewer
  vec2 place;               // texture coordinates
  vec3 along_u, along_v;    // directions in which these grow, not normalized
  bool is_behind;           // seen from the side opposite to the surface's normal
  bool is_holed;            // BTF whose values are averages that include the holes of its structure
  vec2 beyond;              // HoledBtfMaterial: offset to its mirror image beyond a silhouette; 0: none nearby
};

// Direction towards the viewer.
vec3 view_from_here() { return eye.w > 0.0 ? normalize(eye.xyz - world) : eye.xyz; }

// Interpolated normals may face away at a silhouette.
vec3 facing(vec3 n, vec3 view)
{
  float cosine = dot(n, view);
  return cosine < 0.01 ? normalize(n + (0.01 - cosine) * view) : n;
}

// Mirrored triangles have the opposite winding.
bool is_back() { return gl_FrontFacing == (handed < 0.0); }

vec3 normal_towards(vec3 view, out bool is_behind)
{
  vec3 flat_normal = normalize(cross(dFdx(world), dFdy(world)));
  if (dot(flat_normal, view) < 0.0) flat_normal = -flat_normal;
  bool is_flat = dot(shading_normal, shading_normal) == 0.0;
  vec3 n = is_flat ? flat_normal : normalize(shading_normal);
  is_behind = is_flat ? is_back() : dot(n, flat_normal) < 0.0;
  if (dot(n, flat_normal) < 0.0) n = -n;
  return facing(n, view);
}

// Pixel of a surface that reflects `light`.
vec4 seen(vec3 light) { return holdout > 0.5 ? vec4(0) : vec4(light, 1); }

// Directions on the surface in which u and v grow, not normalized.
void tangents(out vec3 along_u, out vec3 along_v)
{
  vec3 px = dFdx(world), py = dFdy(world);
  vec2 tx = dFdx(coordinates), ty = dFdy(coordinates);
  float turn = sign(tx.x * ty.y - tx.y * ty.x);
  along_u = turn * (px * ty.y - py * tx.y);
  along_v = turn * (py * tx.x - px * ty.x);
}

// Frame with z = n, and x as close to `along` as possible.
mat3 frame_about(vec3 n, vec3 along)
{
  vec3 x = along - dot(along, n) * n;
  if (dot(x, x) < 1e-20) x = abs(n.x) < 0.9 ? vec3(1, 0, 0) - n.x * n : vec3(0, 1, 0) - n.y * n;
  x = normalize(x);
  return mat3(x, cross(n, x), n);
}

// Five pixels per light: position or direction, kind; color, squared radius; axis, with the cosine at the edge of a
// spot's cone or the cotangent of half an area light's spread (0: emits everywhere); for a spot, its axes over the
// scale of its cone (0: scale 1), with the width of the rim, and whether its light falls off with the cosine.
const int LAMP_PIXELS = 5;
const float SUN = 0.0, AREA = 2.0, SPOT = 3.0;

vec4 lamp_pixel(int lamp, int i) { return texelFetch(lamps, ivec2(LAMP_PIXELS * lamp + i, 0), 0); }

// Mean of max(t, 0) over a disk, where t is `middle` at its center and rises by `blur` towards its edge.
float mean_above(float middle, float blur)
{
  if (abs(middle) >= blur) return max(middle, 0.0);
  float y = middle / blur;
  return blur * ((2.0 + y * y) * sqrt(1.0 - y * y) / (3.0 * PI) + y * (0.5 + asin(y) / PI));
}

// Mean of Lamp::falloff over a disk light with a spread, accurate to 2% if the disk is at most a third as wide as what
// it lights. `path`, to its center, and the squared radius become those of the part that emits towards this point.
float spread_share(vec4 axis, inout vec3 path, inout float radius_sq)
{
  float height = max(-dot(path, axis.xyz), 1e-6);
  vec3 aside = -path - height * axis.xyz;
  float off = axis.w / height * length(aside), size = axis.w / height * sqrt(radius_sq);
  float far = sqrt(off * off + 0.3 * size * size), own = 0.6 / (0.6 + size * size);
  path += (1.0 - own) * aside;
  radius_sq *= own;
  return mean_above(1.0 - far, size * off / max(far, 1e-6));
}

// Lamp::falloff of a spot; `direction`: unit vector from it.
float cone_share(int lamp, vec3 direction, vec4 axis)
{
  vec4 x = lamp_pixel(lamp, 3), y = lamp_pixel(lamp, 4);
  float cosine = dot(direction, axis.xyz);
  if (x.xyz != vec3(0)) cosine /= length(vec3(dot(direction, x.xyz), dot(direction, y.xyz), cosine));
  return smoothstep(0.0, 1.0, (cosine - axis.w) / max(x.w, 1e-6)) * (y.w > 0.0 ? max(cosine, 0.0) : 1.0);
}

// Irradiance of a plane that faces the light; `light`: unit vector towards it; `bandwidth`: of its visible extent.
vec3 lamp_light(int lamp, out vec3 light, out float bandwidth)
{
  vec4 where = lamp_pixel(lamp, 0), color = lamp_pixel(lamp, 1), axis = lamp_pixel(lamp, 2);
  if (where.w == SUN) {
    light = where.xyz;
    bandwidth = 4.0 / max(color.w, 1e-6);
    return color.rgb;
  }
  vec3 path = where.xyz - world;
  float radius_sq = color.w, share = 1.0;
  if (where.w == AREA && axis.w > 0.0) share = spread_share(axis, path, radius_sq);
  float square = max(dot(path, path), 1e-8);
  light = path * inversesqrt(square);
  bandwidth = 4.0 * square / max(radius_sq, 1e-6 * square);
  if (where.w == AREA) share *= max(-dot(light, axis.xyz), 0.0);
  if (where.w == SPOT) share = cone_share(lamp, -light, axis);
  return color.rgb * share / square;
}
