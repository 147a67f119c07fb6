// Shades the library's rows of lobes (native/src/realtime/lobe_rows.h) under environment and lights, without shadows.

struct Lobe {
  vec3 center;
  float level;
  vec3 color;
};

struct Place {
  ivec2 low;   // lower row and column of the grid of views
  vec2 share;  // weights of the next ones
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

vec3 base_color = vec3(0);  // only with PICTURE

void add_row(int lobe, int row, float share, inout vec4 shape, inout vec3 color)
{
  shape += share * texelFetch(lobe_rows, ivec2(2 * lobe, row), 0);
  vec3 found = texelFetch(lobe_rows, ivec2(2 * lobe + 1, row), 0).rgb;
#ifdef PICTURE
  found = mix(found, texelFetch(white_rows, ivec2(2 * lobe + 1, row), 0).rgb, base_color);
#endif
  color += share * found;
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

// Density of a normalized Gaussian, convolved with the light's own bandwidth, or of the clamped cosine over pi.
float density(Lobe lobe, vec3 normal, vec3 center, vec3 light, float lamp_bandwidth)
{
  if (lobe.level < 0.5) return max(dot(normal, light), 0.0) / PI;
  float own = exp2((lobe.level - 1.0) / LEVELS_OF_OCTAVE);
  float both = own * lamp_bandwidth / (own + lamp_bandwidth);
  vec3 apart = center - light;
  return both / (2.0 * PI * (1.0 - exp(-2.0 * both))) * exp(-0.5 * both * dot(apart, apart));
}

void main()
{
  Site site = site_here(vec2(0));
  vec3 n = site.normal;
  mat3 frame = frame_about(n, is_isotropic() ? site.view : site.along_u);
  Place place = place_of(site.view * frame);
#ifdef PICTURE
  base_color = picture_color(site.place);
#endif
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
  pixel = seen(gain.rgb * max(sum, vec3(0)) + emission.rgb);
}
