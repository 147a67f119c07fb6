// Surface of a pixel in a shell (VOTF): the structure that the view ray hits below the top, which is the drawn mesh;
// rays without a hit pass through. Sphere tracing as in votf/eval/shell_trace.h and render/path/shell_crossing.h.
// shell_maps: native/src/realtime/maps.h; shell_terms: bottom, top, reference, aspect; then the largest distance
// that the maps resolve, and whether the structure is open.

const int DEPTH_LOOKS = 64;
const int LOOKS = 160;  // a ray that grazes the structure for this many steps counts as a hit
const float WITHIN = 0.03, LEAST_STEP = 0.1;  // relative to the spacing of points
const float STRIDE = 1.6;                     // step length relative to the distance
const float LEAST_COSINE = 0.15;

vec4 shell_terms_here() { return texelFetch(shell_terms, ivec2(0), 0); }

// Distance and its gradient at `q`, in tile widths.
vec4 shell_at(vec3 q)
{
  vec4 terms = shell_terms_here();
  vec3 size = vec3(textureSize(shell_maps, 0));
  vec2 periods = vec2(q.x, q.y / terms.w);
  vec2 pixel = (periods - floor(periods)) * (size.xy - 2.0) + 1.0;
  float height = clamp((q.z - terms.x) / (terms.y - terms.x), 0.0, 1.0) * (size.z - 1.0) + 0.5;
  return textureLod(shell_maps, vec3(pixel, height) / size, 0.0);
}

// ShellRay, ShellWay.
struct ShellWay {
  vec2 place, along;
  float sine, cosine, curvature, scale, begin, end;
  float speed;  // upper bound, in tile widths per meter
};

// ShellRay::at, relative to the surface.
vec3 way_at(ShellWay way, float s, float top)
{
  float a = s * way.sine, bent = way.curvature * a, far = abs(bent);
  float b = max(1.0 - way.curvature * s * way.cosine, 0.1 * far);
  float fall = s * (way.curvature * s - 2.0 * way.cosine);
  float deeper = fall / (1.0 + sqrt(b * b + bent * bent));
  float across = bent == 0.0 ? a : a * atan(far, b) / far;
  return vec3(way.place + way.along * across, top + way.scale * deeper);
}

// Distance in meters from the crossing of the top to the exit from the shell; 0 if the ray leaves through the top again
// and is seen from within, since it is handled at its entry.
float way_end(ShellWay way, float depth, bool leaves)
{
  float down = depth / way.scale, fall = down * (2.0 - way.curvature * down);
  float square = way.cosine * way.cosine - way.curvature * fall;
  if (square >= 0.0) return fall / max(way.cosine + sqrt(square), 1e-6);
  return leaves ? 0.0 : 2.0 * way.cosine / way.curvature;
}

float pitch() { return 1.0 / float(textureSize(shell_maps, 0).x - 2); }

float way_speed(ShellWay way, float depth)
{
  float radius = max(1.0 - max(way.curvature * depth, 0.0) / way.scale, 1.0 / 3.0);
  return length(vec2(length(way.along) * way.sine / (radius * radius),
                     way.scale * (way.curvature < 0.0 ? 1.0 : way.cosine)));
}

// Whether the ray hits the structure, and where. Takes the steps of votf/eval/shell_march-inl.h, since shading near a
// silhouette is sensitive to the hit point.
bool met(ShellWay way, float top, out float s)
{
  float pitch = pitch(), turn = way.end < way.begin ? -1.0 : 1.0, per_speed = turn / way.speed;
  float free = 0.0, stride = 0.0;  // last sample: `stride` tile widths back, and `free` away from any surface
  s = way.begin;
  for (int i = 0; i < LOOKS; ++i) {
    float distance = shell_at(way_at(way, s, top)).x;
    if (distance <= WITHIN * pitch) {
      if (i > 0) s -= per_speed * stride * min(1.0, distance / (distance - free));
      return true;
    }
    if (free + distance < stride) {  // there may be structure in between: go back to the certainly free part
      s -= per_speed * (stride - free);
      stride = free;
      continue;
    }
    free = max(distance, LEAST_STEP * pitch);
    if ((s + per_speed * free - way.end) * turn >= 0.0) return false;
    stride = min(STRIDE * free, (way.end - s) / per_speed);
    s += per_speed * stride;
  }
  return true;
}

// Largest depth within the structure along a ray from `from` on, and where; stops once it reaches `most`. See
// ShellDepth.
vec2 deepest_behind(ShellWay way, float top, float from, float most)
{
  float far = abs(way.end - from), stride = max(pitch() / way.speed, far / float(DEPTH_LOOKS));
  float turn = way.end < from ? -1.0 : 1.0;
  vec2 deepest = vec2(-1e9, from);
  for (int i = 0; i <= DEPTH_LOOKS && float(i - 1) * stride < far && deepest.x < most; ++i) {
    float s = from + turn * min(float(i) * stride, far), depth = -shell_at(way_at(way, s, top)).x;
    if (depth > deepest.x) deepest = vec2(depth, s);
  }
  return deepest;
}

// ShellField::gradient, since the gradients of the table are too smooth within thin structure.
vec3 slope_at(vec3 q)
{
  vec3 slope;
  for (int axis = 0; axis < 3; ++axis) {
    vec3 half_pitch = vec3(0);
    half_pitch[axis] = 0.5 * pitch();
    slope[axis] = (shell_at(q + half_pitch).x - shell_at(q - half_pitch).x) / pitch();
  }
  return slope;
}

// ShellCrossing::beyond_outline.
vec2 beyond_outline(ShellWay way, float top, float s, vec2 texels)
{
  vec2 widths = vec2(1.0, shell_terms_here().w), texel = widths / texels;
  float most = min(1.5 * max(texel.x, texel.y), 0.9 * texelFetch(shell_terms, ivec2(1, 0), 0).x);
  vec2 deepest = deepest_behind(way, top, s, most);
  if (deepest.x >= most) return vec2(0);
  vec3 place = way_at(way, deepest.y, top), slope = slope_at(place);
  float ahead = (way.end < s ? -1.0 : 1.0) * pitch() / way.speed;
  vec3 along = normalize(way_at(way, deepest.y + ahead, top) - place), across = slope - dot(slope, along) * along;
  vec2 outside = across.xy / max(length(across), 1e-9);
  float depth = deepest.x, square = dot(outside, outside);
  if (depth <= 0.0 || depth >= 1.5 * length(outside * texel) || square <= 0.0) return vec2(0);
  vec2 over = outside * (2.0 * depth / square);
  // There is no silhouette if other structure is behind.
  way.place += over;
  return deepest_behind(way, top, way.begin, 0.0).x > 0.0 ? vec2(0) : over / widths;
}

// `texels`: number of texels of a BTF's tile, whose place is where the ray crosses the plane of its texels, with the
// normal of the smooth surface; 0: no BTF, and the normal is that of the structure.
Site site_here(vec2 texels)
{
  Site site;
  site.view = view_from_here();
  tangents(site.along_u, site.along_v);
  vec4 terms = shell_terms_here();
  // Gradients of the image's x and y along the surface, to convert screen-space derivatives.
  vec3 px = dFdx(world), py = dFdy(world), across = cross(px, py), n = normalize(up);
  float area = max(dot(across, across), 1e-30);
  vec3 per_x = cross(py, across) / area, per_y = cross(across, px) / area;
  vec2 uv_x = dFdx(coordinates), uv_y = dFdy(coordinates);
  vec3 turn_x = dFdx(n), turn_y = dFdy(n);
  bool leaves = dot(site.view, dot(across, n) < 0.0 ? -across : across) < 0.0;
  vec3 down = leaves ? site.view : -site.view;

  ShellWay way;
  way.cosine = clamp(-dot(down, n), 0.0, 1.0);
  way.sine = sqrt(1.0 - way.cosine * way.cosine);
  way.scale = 1.0 / tile_width;
  vec3 unit = down + way.cosine * n;
  unit /= max(length(unit), 1e-9);
  float a = dot(unit, per_x), b = dot(unit, per_y);
  vec3 normal_turn = a * turn_x + b * turn_y;
  vec2 widths = vec2(1.0, terms.w);
  way.curvature = dot(normal_turn, unit);
  way.place = widths * coordinates;
  way.along = widths * (a * uv_x + b * uv_y);
  way.speed = way_speed(way, terms.y - terms.x);
  float end = way_end(way, terms.y - terms.x, leaves), s = 0.0;
  way.begin = leaves ? end : 0.0;
  way.end = leaves ? 0.0 : end;
  if (tile_width <= 0.0 || way.cosine <= 0.0 || end <= 0.0 || !met(way, terms.y, s)) discard;

  vec3 q = way_at(way, s, terms.y), over = normalize(n + s * way.sine * normal_turn);
  vec3 u_gradient = uv_x.x * per_x + uv_y.x * per_y, v_gradient = uv_x.y * per_x + uv_y.y * per_y;
  site.is_behind = leaves;
  site.beyond = vec2(0);
  site.is_holed = texels != vec2(0) && texelFetch(shell_terms, ivec2(1, 0), 0).y > 0.0;
  if (texels == vec2(0)) {
    vec3 slope = shell_at(q).yzw;
    vec3 own = slope.x * u_gradient + slope.y * terms.w * v_gradient + slope.z * way.scale * over;
    site.normal = own / max(length(own), 1e-20);
    site.place = q.xy / widths;
  } else {
    vec3 towards = -down;
    float cosine = dot(towards, over);
    vec3 to_plane = (towards - cosine * over) * ((terms.z - q.z) / (way.scale * max(cosine, LEAST_COSINE)));
    site.normal = leaves ? -over : over;
    site.place = q.xy / widths + vec2(dot(u_gradient, to_plane), dot(v_gradient, to_plane));
    if (site.is_holed) site.beyond = beyond_outline(way, terms.y, s, texels);
  }
  site.normal = facing(site.normal, site.view);
  return site;
}
