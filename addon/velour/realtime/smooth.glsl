// Where a pixel's surface is: on the mesh itself.

Site site_here(bool on_structure)
{
  Site site;
  site.view = view_from_here();
  site.normal = normal_towards(site.view);
  site.place = coordinates;
  tangents(site.along_u, site.along_v);
  return site;
}
