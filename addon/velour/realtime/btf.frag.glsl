// Maps of a BTF of multivariate SRBFs (native/src/realtime/btf_maps.h, btf/srbf_btf.h), lit by the world and by lamps.
// btf_terms, first row: how many levels, lowest and highest of the relief, aspect; then of each level x, width, height of
// its map, and from pixel 17 on the columns of the matrix from Rec. 709 to the working space. Second row: of each coefficient light and phase; view and whether it is in the tile's frame; half and the sum
// of all lengths; colour.

const int LIGHTS = 16, MOST_LAMPS = 16;
const float GOLDEN = 2.39996323;

vec4 level_info(int level) { return texelFetch(btf_terms, ivec2(1 + level, 0), 0); }

// `texel`: from the centre of the first one, of a tile that repeats.
vec4 map_at(int layer, int level, vec2 texel)
{
  vec4 info = level_info(level);
  vec2 inside = texel - floor(texel / info.yz) * info.yz;
  return textureLod(btf_maps, vec3((vec2(info.x, 1) + inside + 0.5) / vec2(textureSize(btf_maps, 0).xy), layer), 0.0);
}

// Where the view's ray first is not above the relief: Relief::seen_texel, in steps of half a texel.
vec2 seen_texel(int level, vec2 place, vec3 wv, int relief)
{
  vec4 tile = texelFetch(btf_terms, ivec2(0, 0), 0);
  vec2 size = level_info(level).yz;
  vec2 shift = size * vec2(wv.x, wv.y / tile.w) / max(wv.z, 1e-4), on_plane = place * size - 0.5;
  if (tile.z <= tile.y) return on_plane + tile.y * shift;
  vec2 from = on_plane + tile.z * shift, way = (tile.y - tile.z) * shift;
  int steps = clamp(int(2.0 * max(abs(way.x), abs(way.y))) + 1, 2, 64);
  float before = 0.0, gap_before = tile.z - map_at(relief, level, from).x;
  for (int i = 1; i <= steps; ++i) {
    float when = float(i) / float(steps);
    float gap = mix(tile.z, tile.y, when) - map_at(relief, level, from + when * way).x;
    if (gap <= 0.0) return from + mix(before, when, gap_before / max(gap_before - gap, 1e-9)) * way;
    before = when;
    gap_before = gap;
  }
  return from + way;
}

// Takes the relief's normal to +z the shortest way.
mat3 to_normal(vec2 slope)
{
  float square = 1.0 + dot(slope, slope), size = sqrt(square), one = 1.0 / (square + size);
  float z = one * (size + 1.0), a = one * square;
  vec3 n = vec3(slope * z, z);
  float xy = -a * n.x * n.y;
  return mat3(vec3(1.0 - a * n.x * n.x, xy, n.x), vec3(xy, 1.0 - a * n.y * n.y, n.y), vec3(-n.x, -n.y, n.z));
}

// How many times a pixel's shorter side is as wide as a texel of the finest level, as a level; a longer side is left to
// the pictures that add up to a mean, up to four times as long.
float level_of_pixel(float last)
{
  vec2 size = level_info(0).yz, dx = dFdx(coordinates) * size, dy = dFdy(coordinates) * size;
  float a = length(dx), b = length(dy), texels = max(min(a, b), max(a, b) / 4.0);
  return clamp(log2(max(texels, 1e-6)), 0.0, last);
}

// Integral of the product of two Gaussians, each of an integral of 1.
float product(vec3 a, float la, vec3 b, float lb)
{
  vec3 apart = a - b;
  float square = dot(apart, apart), sum = sqrt((la - lb) * (la - lb) + la * lb * (4.0 - square));
  float both = 2.0 * PI / sum * (1.0 - exp(-2.0 * sum)) * exp(-la * lb * square / (sum + la + lb));
  return both * la / (2.0 * PI * (1.0 - exp(-2.0 * la))) * lb / (2.0 * PI * (1.0 - exp(-2.0 * lb)));
}

void main()
{
  float level = level_of_pixel(texelFetch(btf_terms, ivec2(0, 0), 0).x - 1.0);
  Site site = site_here(false);
  mat3 frame = frame_about(site.normal, site.along_u);
  if (dot(frame[1], site.along_v) < 0.0) frame[1] = -frame[1];
  vec3 wv = site.view * frame;
  int relief = textureSize(btf_maps, 0).z - 1;
  int fine = int(level);
  float part = level - float(fine);
  vec2 texel = seen_texel(fine, site.place - floor(site.place), wv, relief), coarse = texel;
  if (part > 0.0) coarse = (texel + 0.5) * level_info(fine + 1).yz / level_info(fine).yz - 0.5;
  vec2 slope = map_at(relief, fine, texel).yz;
  if (part > 0.0) slope = mix(slope, map_at(relief, fine + 1, coarse).yz, part);
  mat3 turn = to_normal(slope);

  // Even directions of the cosine, each for a lobe as wide as its share; then lamps. `emission.w` turns them.
  vec3 wl[LIGHTS + MOST_LAMPS], arrives[LIGHTS + MOST_LAMPS], sums[LIGHTS + MOST_LAMPS];
  for (int i = 0; i < LIGHTS; ++i) {
    float u = (float(i) + 0.5) / float(LIGHTS), azimuth = GOLDEN * float(i) + emission.w;
    wl[i] = vec3(sqrt(u) * vec2(cos(azimuth), sin(azimuth)), sqrt(1.0 - u));
    float lobe = 1.0 + LEVELS_OF_OCTAVE * log2(max(2.0 * float(LIGHTS) * wl[i].z, 1.0));
    arrives[i] = PI / float(LIGHTS) * mean_light(lobe, frame * wl[i]);
    sums[i] = vec3(0);
  }
  int count = LIGHTS;
  // Narrow lobes of the world are lamps: directions so far apart would blur them. RealtimeScene.check() has that all of
  // them fit; what is written here never leaves the arrays.
  for (int narrow = 0; narrow < layout_.w; ++narrow) {
    int at = 4 * (int(gain.w) + narrow);
    vec3 axis = texelFetch(lamps, ivec2(at, 0), 0).xyz;
    vec4 energy = texelFetch(lamps, ivec2(at + 1, 0), 0);
    for (int i = 0; i < LIGHTS; ++i) {
      float lobe = 2.0 * float(LIGHTS) * wl[i].z;
      arrives[i] -= PI / float(LIGHTS) * energy.rgb * product(frame * wl[i], max(lobe, 1.0), axis, energy.w);
    }
    vec3 local = axis * frame;
    if (local.z <= 0.0 || count == LIGHTS + MOST_LAMPS) continue;
    wl[count] = local;
    arrives[count] = local.z * energy.rgb;
    sums[count++] = vec3(0);
  }
  for (int lamp = 0; lamp < int(gain.w); ++lamp) {
    vec3 light;
    float bandwidth;
    vec3 irradiance = lamp_light(lamp, light, bandwidth);
    vec3 local = light * frame;
    if (local.z <= 0.0 || count == LIGHTS + MOST_LAMPS) continue;
    wl[count] = local;
    arrives[count] = local.z * irradiance;
    sums[count++] = vec3(0);
  }

  for (int layer = 0; layer < relief; ++layer) {
    vec4 value = map_at(layer, fine, texel);
    if (part > 0.0) value = mix(value, map_at(layer, fine + 1, coarse), part);
    for (int k = 0; k < 4 && 4 * layer + k < layout_.y; ++k) {
      int at = 4 * (4 * layer + k);
      vec4 of_light = texelFetch(btf_terms, ivec2(at, 1), 0), of_view = texelFetch(btf_terms, ivec2(at + 1, 1), 0);
      vec4 of_half = texelFetch(btf_terms, ivec2(at + 2, 1), 0);
      vec3 color = value[k] * texelFetch(btf_terms, ivec2(at + 3, 1), 0).rgb;
      // What is of the relief's frame is turned into the tile's: dot(a, turn b) = dot(a turn, b).
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
  pixel = vec4(gain.rgb * max(sum, vec3(0)), 1);
}
