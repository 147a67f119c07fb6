/* The public header is C99: this file includes nothing else of ours, and calls across every kind of function. */
#include "velour/velour.h"

#include <stdio.h>

int main(void) {
  vlr_fit_options fit;
  vlr_microsurface_options capture;
  vlr_render_options render;
  vlr_scene* scene = NULL;
  const char* json = NULL;
  vlr_fit_options_init(&fit);
  vlr_microsurface_options_init(&capture);
  vlr_render_options_init(&render);
  if (vlr_abi_version() != VLR_ABI_VERSION) return 1;
  if (fit.struct_size != sizeof fit || render.split == 0 || capture.metal == NULL) return 2;
  if (vlr_self_test() != VLR_OK || vlr_system_json(&json) != VLR_OK) {
    fprintf(stderr, "%s\n", vlr_last_error());
    return 3;
  }
  if (vlr_scene_create(&scene) != VLR_OK) return 4;
  vlr_scene_free(scene);
  vlr_scene_free(NULL);
  return 0;
}
