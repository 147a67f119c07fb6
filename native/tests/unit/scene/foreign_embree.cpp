// A stand-in for another Embree in the process: every entry point exists, answers garbage and never hits.
#define VELOUR_FOREIGN(name) \
  extern "C" __attribute__((visibility("default"))) void* name() { return nullptr; }
#include "foreign_embree_names.inc"
