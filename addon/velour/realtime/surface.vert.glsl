// Vertices of a mesh or, with SHELL, of the top of its shell (shell.glsl).
// layout_: first instance, bitwise inverted if backs are hidden, then three values from the tables (tables.py). BRDF:
// lobes per place, places along a side (negative: anisotropic), whether places blend. BTF: number of sides, whether
// roots are stored, number of narrow lobes.

void main()
{
  int first = layout_.x < 0 ? ~layout_.x : layout_.x;
  int at = (first + gl_InstanceID) * 5;
  int width = textureSize(instances, 0).x;
  vec4 row[5];
  for (int i = 0; i < 5; ++i) row[i] = texelFetch(instances, ivec2((at + i) % width, (at + i) / width), 0);
  world = vec3(dot(row[0], vec4(position, 1)), dot(row[1], vec4(position, 1)), dot(row[2], vec4(position, 1)));
  // Cofactors: the inverse transpose times the determinant, whose sign `turn` removes.
  mat3 cofactors = mat3(cross(row[1].xyz, row[2].xyz), cross(row[2].xyz, row[0].xyz), cross(row[0].xyz, row[1].xyz));
  float turn = sign(dot(row[0].xyz, cofactors[0]));
  shading_normal = turn * (normal * cofactors);
  handed = turn;
  holdout = row[4].w;
#ifdef SHELL
  tile_width = row[3].w;
  up = normalize(turn * (lift * cofactors));
  world += texelFetch(shell_terms, ivec2(0), 0).y * tile_width * up;
#endif
  coordinates = vec2(dot(row[3].xyz, vec3(uv, 1)), dot(row[4].xyz, vec3(uv, 1)));
  gl_Position = view_projection * vec4(world, 1);
}
