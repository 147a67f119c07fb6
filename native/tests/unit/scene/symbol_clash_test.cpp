// Velour's rays must hit although another library already offers every rtc* symbol to the whole process, as Blender's
// own Embree does.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include "scene/embree_scene.h"

namespace velour::symbol_clash_test {
namespace {

TEST(SymbolClash, OwnEmbreeIsUsedWithAForeignOneLoadedGlobally) {
  void* foreign = dlopen(VELOUR_FOREIGN_EMBREE, RTLD_NOW | RTLD_GLOBAL);
  ASSERT_NE(foreign, nullptr) << dlerror();
  // The trap is set: a plain look-up in the process finds the foreign symbol.
  const auto global = reinterpret_cast<void* (*)()>(dlsym(RTLD_DEFAULT, "rtcNewDevice"));
  ASSERT_EQ(reinterpret_cast<void*>(global), dlsym(foreign, "rtcNewDevice"));
  ASSERT_EQ(global(), nullptr);
  EXPECT_NO_THROW(embree_self_test());
  EXPECT_EQ(embree_info().path.find("foreign"), std::string::npos);
}

}  // namespace
}  // namespace velour::symbol_clash_test
