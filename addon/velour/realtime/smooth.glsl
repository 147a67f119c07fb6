// Surface of a pixel: the mesh itself.

Site site_here(vec2 texels)
{
  Site site;
  site.view = view_from_here();
  site.normal = normal_towards(site.view, site.is_behind);
  site.place = coordinates;
  site.beyond = vec2(0);
  site.is_holed = false;
  tangents(site.along_u, site.along_v);
  if (layout_.x < 0 && is_back()) discard;
  return site;
}
