// Base color texture (pictures.py), with the point lookup of material/texture.h.
// picture_terms: both rows of the matrix from (u, v, 1) to the image, with wrap and filter as fourth components.
#ifdef PICTURE

const int REPEAT = 0, EXTEND = 1, CLIP = 2, CLOSEST = 0;

vec3 picture_texel(ivec2 at, int wrap)
{
  ivec2 size = textureSize(picture, 0);
  bool is_outside = any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size));
  if (is_outside && wrap == CLIP) return vec3(0);
  if (wrap == REPEAT) at = (at + size) % size;
  return texelFetch(picture, clamp(at, ivec2(0), size - 1), 0).rgb;
}

vec2 reduced(vec2 uv, int wrap)
{
  if (wrap == REPEAT) return uv - floor(uv);
  if (wrap == EXTEND) return clamp(uv, 0.0, 1.0);
  if (wrap == CLIP) return clamp(uv, -2.0, 3.0);
  return 1.0 - abs(uv - 2.0 * floor(0.5 * uv) - 1.0);
}

vec3 picture_color(vec2 uv)
{
  vec4 u = texelFetch(picture_terms, ivec2(0, 0), 0), v = texelFetch(picture_terms, ivec2(1, 0), 0);
  int wrap = int(u.w);
  vec2 at = reduced(vec2(dot(u.xyz, vec3(uv, 1)), dot(v.xyz, vec3(uv, 1))), wrap) * vec2(textureSize(picture, 0));
  if (int(v.w) == CLOSEST) return clamp(picture_texel(ivec2(floor(at)), wrap), 0.0, 1.0);
  at -= 0.5;
  ivec2 low = ivec2(floor(at));
  vec2 part = at - floor(at);
  vec3 bottom = mix(picture_texel(low, wrap), picture_texel(low + ivec2(1, 0), wrap), part.x);
  vec3 top = mix(picture_texel(low + ivec2(0, 1), wrap), picture_texel(low + ivec2(1, 1), wrap), part.x);
  return clamp(mix(bottom, top, part.y), 0.0, 1.0);
}

#endif
