#include "scene/scene.h"

#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/render_reports.h"

using namespace velour;
using namespace velour::capi;

vlr_status vlr_scene_create(vlr_scene** out) {
  return guard([&] {
    require(out, "out");
    embree_self_test();
    *out = new vlr_scene{std::make_shared<Scene>(), {}, 0};
  });
}

void vlr_scene_free(vlr_scene* scene) { delete scene; }

vlr_status vlr_scene_set_working_space(vlr_scene* scene, const float* rec709_to_working) {
  return guard([&] {
    require(scene, "scene");
    require(rec709_to_working, "rec709_to_working");
    scene->scene->set_working_space(matrix_from_rows(rec709_to_working));
  });
}

vlr_status vlr_scene_stay(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->stay();
  });
}

vlr_status vlr_scene_commit(vlr_scene* scene) {
  return guard([&] {
    require(scene, "scene");
    scene->scene->commit();
  });
}

vlr_status vlr_scene_info_json(vlr_scene* scene, const char** json) {
  return guard([&] {
    require(scene, "scene");
    require(json, "json");
    scene->info = scene_json(*scene->scene);
    *json = scene->info.c_str();
  });
}
