void main()
{
  ivec2 at = ivec2(gl_FragCoord.xy);
  pixel = mix(texelFetch(average, at, 0), texelFetch(latest, at, 0), share);
}
