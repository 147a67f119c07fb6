void main()
{
  vec4 near = inverse_projection * vec4(place, -1, 1), far = inverse_projection * vec4(place, 1, 1);
  pixel = vec4(exposure * light_of_level(SKY_LEVEL, octahedral(normalize(far.xyz / far.w - near.xyz / near.w))), 1);
}
