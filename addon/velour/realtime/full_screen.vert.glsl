void main()
{
  place = position;
  gl_Position = vec4(position, 0, 1);
}
