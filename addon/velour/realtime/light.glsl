// The light map of the library (native/src/realtime/light_map.h).

const float PI = 3.14159265;
const int SKY_LEVEL = 28;
const float LEVELS_OF_OCTAVE = 2.0;

vec2 octahedral(vec3 w)
{
  vec2 p = w.xy / (abs(w.x) + abs(w.y) + abs(w.z));
  if (w.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(w.x < 0.0 ? -1.0 : 1.0, w.y < 0.0 ? -1.0 : 1.0);
  return 0.5 * p + 0.5;
}

vec3 light_of_level(int level, vec2 square)
{
  vec4 map = texelFetch(light_map, ivec2(level, 0), 0);
  return textureLod(light_map, (map.xy + square * map.z) / vec2(textureSize(light_map, 0)), 0.0).rgb;
}

// Mean of the light over the lobe of `level` around the unit vector `w`.
vec3 mean_light(float level, vec3 w)
{
  vec2 square = octahedral(w);
  int below = int(level);
  float t = level - float(below);
  vec3 low = light_of_level(below, square);
  return t > 0.0 ? mix(low, light_of_level(below + 1, square), t) : low;
}
