// Rows of lobes of the library (native/src/realtime/lobe_rows.h), lit by the world and by lamps, without shadows.

struct Lobe {
  vec3 center;
  float level;
  vec3 color;
};

struct Place {
  ivec2 low;   // of the grid of views
  vec2 share;  // of what follows
};

int side() { return abs(layout_.z); }
bool is_isotropic() { return layout_.z > 0; }

Place place_of(vec3 wv)
{
  float sine = length(wv.xy), radius = atan(sine, wv.z) / (0.5 * PI), last = float(side() - 1);
  vec2 azimuth = sine > 0.0 ? wv.xy / sine : vec2(1, 0);
  vec2 at = is_isotropic() ? vec2(radius * last, 0) : 0.5 * (radius * azimuth + 1.0) * last;
  if (layout_.w == 0) at = floor(at + 0.5);
  vec2 low = clamp(floor(at), vec2(0), vec2(last - 1.0));
  return Place(ivec2(low), at - low);
}

void add_row(int lobe, int row, float share, inout vec4 shape, inout vec3 color)
{
  shape += share * texelFetch(lobe_rows, ivec2(2 * lobe, row), 0);
  color += share * texelFetch(lobe_rows, ivec2(2 * lobe + 1, row), 0).rgb;
}

Lobe lobe_at(Place place, int lobe)
{
  vec4 shape = vec4(0);
  vec3 color = vec3(0);
  int row = place.low.y * side() + place.low.x;
  vec2 t = place.share;
  add_row(lobe, row, (1.0 - t.x) * (1.0 - t.y), shape, color);
  add_row(lobe, row + 1, t.x * (1.0 - t.y), shape, color);
  if (!is_isotropic()) {
    add_row(lobe, row + side(), (1.0 - t.x) * t.y, shape, color);
    add_row(lobe, row + side() + 1, t.x * t.y, shape, color);
  }
  return Lobe(normalize(shape.xyz), shape.w, color);
}

// x along the tangent of the texture coordinates, of isotropic models along the view's azimuth.
mat3 frame_about(vec3 n, vec3 view)
{
  vec3 x = is_isotropic() ? view : vec3(0);
  if (!is_isotropic()) {
    vec3 px = dFdx(world), py = dFdy(world);
    vec2 tx = dFdx(coordinates), ty = dFdy(coordinates);
    x = (px * ty.y - py * tx.y) * sign(tx.x * ty.y - tx.y * ty.x);
  }
  x -= dot(x, n) * n;
  if (dot(x, x) < 1e-20) x = abs(n.x) < 0.9 ? vec3(1, 0, 0) - n.x * n : vec3(0, 1, 0) - n.y * n;
  x = normalize(x);
  return mat3(x, cross(n, x), n);
}

// Of a normalised Gaussian, or of the clipped cosine over pi; a lamp of an own bandwidth blurs both into one.
float density(Lobe lobe, vec3 normal, vec3 center, vec3 light, float lamp_bandwidth)
{
  if (lobe.level < 0.5) return max(dot(normal, light), 0.0) / PI;
  float own = exp2((lobe.level - 1.0) / LEVELS_OF_OCTAVE);
  float both = own * lamp_bandwidth / (own + lamp_bandwidth);
  vec3 apart = center - light;
  return both / (2.0 * PI * (1.0 - exp(-2.0 * both))) * exp(-0.5 * both * dot(apart, apart));
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

void main()
{
  vec3 view = eye.w > 0.0 ? normalize(eye.xyz - world) : eye.xyz;
  vec3 flat_normal = normalize(cross(dFdx(world), dFdy(world)));
  if (dot(flat_normal, view) < 0.0) flat_normal = -flat_normal;
  vec3 n = dot(shading_normal, shading_normal) > 0.0 ? normalize(shading_normal) : flat_normal;
  if (dot(n, flat_normal) < 0.0) n = -n;
  // Interpolated normals may face away at an outline.
  float facing = dot(n, view);
  if (facing < 0.01) n = normalize(n + (0.01 - facing) * view);
  mat3 frame = frame_about(n, view);
  Place place = place_of(view * frame);
  int lamp_count = int(gain.w);
  vec3 sum = vec3(0);
  for (int i = 0; i < layout_.y; ++i) {
    Lobe lobe = lobe_at(place, i);
    if (lobe.color == vec3(0)) continue;
    vec3 center = frame * lobe.center;
    vec3 light = mean_light(lobe.level, center);
    for (int lamp = 0; lamp < lamp_count; ++lamp) {
      vec3 towards;
      float bandwidth;
      vec3 arrives = lamp_light(lamp, towards, bandwidth);
      if (dot(n, towards) > 0.0) light += arrives * density(lobe, n, center, towards, bandwidth);
    }
    sum += lobe.color * light;
  }
  pixel = vec4(gain.rgb * max(sum, vec3(0)) + emission.rgb, 1);
}
