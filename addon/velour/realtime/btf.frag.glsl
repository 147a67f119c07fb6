// Shades a BTF of multivariate SRBFs (native/src/realtime/maps.h, btf/model/srbf_btf.h) under environment and lights.
// btf_terms, first row: number of levels, aspect; then x, width and height of each level's map; from pixel 17 on, the
// columns of the matrix from Rec. 709 to the working space. Then two rows per side, the side above first: number of
// coefficients, first layer, minimum and maximum of the relief; then per coefficient: light and phase; view, and
// whether it is in the tile's frame; half vector and the sum of all lengths; color.

const int LIGHTS = 16, MOST_LAMPS = 16, MOST_LINES = 128;
const float GOLDEN = 2.39996323;
// Rotation from ring to ring, radians. PICTURES of them add up to GOLDEN and whole turns, so that all rings form one
// spiral; of the 32 numbers of whole turns, 17 makes its 512 directions most even.
const float TURN = (17.0 * 2.0 * PI + GOLDEN) / PICTURES;

struct Side {
  int row, first, relief;  // row of its coefficients; its first layer, and that of the relief
  int coefficients;
  float bottom, top;
};

Side side_of(bool below)
{
  int row = below && layout_.y > 1 ? 3 : 1;
  vec4 info = texelFetch(btf_terms, ivec2(0, row), 0);
  int coefficients = int(info.x), first = int(info.y);
  return Side(row + 1, first, first + (coefficients + 3) / 4, coefficients, info.z, info.w);
}

vec4 level_info(int level) { return texelFetch(btf_terms, ivec2(1 + level, 0), 0); }

// `texel`: relative to the center of the first texel; the tile repeats.
vec4 map_at(int layer, int level, vec2 texel)
{
  vec4 info = level_info(level);
  vec2 inside = texel - floor(texel / info.yz) * info.yz;
  return textureLod(btf_maps, vec3((vec2(info.x, 1) + inside + 0.5) / vec2(textureSize(btf_maps, 0).xy), layer), 0.0);
}

// First point of the view ray that is not above the relief: Relief::seen_texel, marching between grid lines like
// relief_march.h. The relief is bilinear between lines, so other step lengths would find other intersections.
vec2 seen_texel(Side side, int level, vec2 place, vec3 wv)
{
  float aspect = texelFetch(btf_terms, ivec2(0, 0), 0).y, depth = side.bottom - side.top;
  vec2 size = level_info(level).yz;
  vec2 shift = size * vec2(wv.x, wv.y / aspect) / max(wv.z, 1e-4), on_plane = place * size - 0.5;
  if (depth >= 0.0) return on_plane + side.bottom * shift;
  vec2 from = on_plane + side.top * shift, way = depth * shift, rate = max(abs(way), 1e-6);
  // Ray parameters of the next column and row lines, beginning with the last ones before the start.
  vec2 each = max(ceil(rate / float(MOST_LINES)), 1.0) / rate;
  vec2 turn = vec2(way.x < 0.0 ? -1.0 : 1.0, way.y < 0.0 ? -1.0 : 1.0);
  vec2 when = -abs(floor(turn * from) - turn * from) / rate;
  float before = -1.0, gap_before = 1.0;
  for (int i = 0; i < 2 * MOST_LINES + 2; ++i) {
    float now = min(when.x, when.y);
    float gap = mix(side.top, side.bottom, now) - map_at(side.relief, level, from + now * way).x;
    if (gap <= 0.0) return from + max(mix(before, now, gap_before / max(gap_before - gap, 1e-9)), 0.0) * way;
    before = now;
    gap_before = gap;
    if (when.x <= when.y) when.x += each.x;
    else when.y += each.y;
    if (now > 1.0) break;
  }
  return from + way;
}

// Smallest rotation that takes the relief's normal to +z.
mat3 to_normal(vec2 slope)
{
  float square = 1.0 + dot(slope, slope), size = sqrt(square), one = 1.0 / (square + size);
  float z = one * (size + 1.0), a = one * square;
  vec3 n = vec3(slope * z, z);
  float xy = -a * n.x * n.y;
  return mat3(vec3(1.0 - a * n.x * n.x, xy, n.x), vec3(xy, 1.0 - a * n.y * n.y, n.y), vec3(-n.x, -n.y, n.z));
}

// Mip level whose texels are as wide as a pixel's shorter side. A longer side, up to four times as long, is left to the
// average of several images.
float level_of_pixel(float last)
{
  vec2 size = level_info(0).yz, dx = dFdx(coordinates) * size, dy = dFdy(coordinates) * size;
  float a = length(dx), b = length(dy), texels = max(min(a, b), max(a, b) / 4.0);
  return clamp(log2(max(texels, 1e-6)), 0.0, last);
}

// Integral of the product of two Gaussians, each with integral 1.
float product(vec3 a, float la, vec3 b, float lb)
{
  vec3 apart = a - b;
  float square = dot(apart, apart), sum = sqrt((la - lb) * (la - lb) + la * lb * (4.0 - square));
  float both = 2.0 * PI / sum * (1.0 - exp(-2.0 * sum)) * exp(-la * lb * square / (sum + la + lb));
  return both * la / (2.0 * PI * (1.0 - exp(-2.0 * la))) * lb / (2.0 * PI * (1.0 - exp(-2.0 * lb)));
}

// Light directions, and the incident light times the cosine.
vec3 wl[LIGHTS + MOST_LAMPS], arrives[LIGHTS + MOST_LAMPS];
int count = 0;

// Bandwidth of a direction's lobe, which covers half of its share of an image's directions: wider lobes would reach
// below the horizon.
float bandwidth_of(vec3 local) { return max(4.0 * float(LIGHTS) * local.z, 1.0); }

// RealtimeScene.check() ensures that all lights fit; this never writes outside of the arrays.
void add_lamp(vec3 local, vec3 irradiance)
{
  if (local.z <= 0.0 || count == LIGHTS + MOST_LAMPS) return;
  wl[count] = local;
  arrives[count++] = local.z * irradiance;
}

// Evenly spread cosine-weighted directions, different ones in each averaged image (number `emission.w`); then lights.
void gather_light(mat3 frame)
{
  float ring = mod(7.0 * emission.w + 0.5 * PICTURES, PICTURES);
  for (int i = 0; i < LIGHTS; ++i) {
    float u = (float(i) + (ring + 0.5) / PICTURES) / float(LIGHTS), azimuth = GOLDEN * float(i) + TURN * ring;
    wl[i] = vec3(sqrt(u) * vec2(cos(azimuth), sin(azimuth)), sqrt(1.0 - u));
    arrives[i] = PI / float(LIGHTS) * mean_light(1.0 + LEVELS_OF_OCTAVE * log2(bandwidth_of(wl[i])), frame * wl[i]);
  }
  count = LIGHTS;
  // Narrow lobes of the environment are treated as lights, since directions this far apart would blur them.
  for (int narrow = 0; narrow < layout_.w; ++narrow) {
    int lamp = int(gain.w) + narrow;
    vec3 axis = lamp_pixel(lamp, 0).xyz;
    vec4 energy = lamp_pixel(lamp, 1);
    for (int i = 0; i < LIGHTS; ++i) {
      float share = product(frame * wl[i], bandwidth_of(wl[i]), axis, energy.w);
      arrives[i] -= PI / float(LIGHTS) * share * energy.rgb;
    }
    add_lamp(axis * frame, energy.rgb);
  }
  for (int lamp = 0; lamp < int(gain.w); ++lamp) {
    vec3 light;
    float bandwidth;
    vec3 irradiance = lamp_light(lamp, light, bandwidth);
    add_lamp(light * frame, irradiance);
  }
}

// Light that a point of the tile reflects.
vec3 reflected(Side side, vec2 place, float level, vec3 wv)
{
  int fine = int(level);
  float part = level - float(fine);
  vec2 texel = seen_texel(side, fine, place - floor(place), wv), coarse = texel;
  if (part > 0.0) coarse = (texel + 0.5) * level_info(fine + 1).yz / level_info(fine).yz - 0.5;
  vec2 slope = map_at(side.relief, fine, texel).yz;
  if (part > 0.0) slope = mix(slope, map_at(side.relief, fine + 1, coarse).yz, part);
  mat3 turn = to_normal(slope);

  vec3 sums[LIGHTS + MOST_LAMPS];
  for (int i = 0; i < count; ++i) sums[i] = vec3(0);
  for (int layer = side.first; layer < side.relief; ++layer) {
    vec4 value = map_at(layer, fine, texel);
    if (part > 0.0) value = mix(value, map_at(layer, fine + 1, coarse), part);
    int first = 4 * (layer - side.first);
    for (int k = 0; k < 4 && first + k < side.coefficients; ++k) {
      int at = 4 * (first + k);
      vec4 of_light = texelFetch(btf_terms, ivec2(at, side.row), 0), of_view = texelFetch(btf_terms, ivec2(at + 1, side.row), 0);
      vec4 of_half = texelFetch(btf_terms, ivec2(at + 2, side.row), 0);
      vec3 color = value[k] * texelFetch(btf_terms, ivec2(at + 3, side.row), 0).rgb;
      // Vectors in the relief's frame are rotated to the tile's: dot(a, turn b) = dot(a turn, b).
      bool in_tile = of_view.w > 0.5;
      vec3 light = in_tile ? of_light.xyz : of_light.xyz * turn, half_way = in_tile ? of_half.xyz : of_half.xyz * turn;
      float from_view = dot(in_tile ? of_view.xyz : of_view.xyz * turn, wv) - of_half.w;
      for (int i = 0; i < count; ++i) {
        float exponent = dot(light, wl[i]) + dot(half_way, normalize(wl[i] + wv)) + of_light.w * dot(wl[i], wv);
        sums[i] += color * exp(exponent + from_view);
      }
    }
  }

  mat3 to_working;
  for (int column = 0; column < 3; ++column) to_working[column] = texelFetch(btf_terms, ivec2(17 + column, 0), 0).xyz;
  vec3 sum = vec3(0);
  for (int i = 0; i < count; ++i) {
    vec3 f = max(sums[i], vec3(0));
    sum += arrives[i] * (to_working * (layout_.z == 1 ? f * f : f));
  }
  return sum;
}

void main()
{
  float level = level_of_pixel(texelFetch(btf_terms, ivec2(0, 0), 0).x - 1.0);
  Site site = site_here(level_info(0).yz);
  // Point lookup: a footprint would average the holes in a second time.
  if (site.is_holed) level = 0.0;
  mat3 frame = frame_about(site.normal, site.along_u);
  if (dot(frame[1], site.along_v) < 0.0) frame[1] = -frame[1];
  vec3 wv = site.view * frame, sum = vec3(0);
  Side side = side_of(site.is_behind);
  gather_light(frame);
  for (int i = 0; i < (site.beyond == vec2(0) ? 1 : 2); ++i) sum += reflected(side, site.place + float(i) * site.beyond, level, wv);
  pixel = seen(gain.rgb * max(sum, vec3(0)));
}
