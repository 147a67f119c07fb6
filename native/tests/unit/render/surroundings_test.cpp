// Cameras that stand inside of things.
#include "usage/observe/scene_observer.h"

#include <gtest/gtest.h>

#include "support/test_scene.h"

namespace velour::surroundings_test {
namespace {

class Veil : public test::ThinLambert {
 public:
  Veil() : ThinLambert(0.5f, 0.5f) {}
  bool opaque() const override { return false; }
};

/// A ball of radius 1 in which the camera is, looking along +x, about a smaller thing in front of it.
struct Room {
  Scene scene;
  uint32_t ball = scene.add_mesh(test::sphere(16)), floor = scene.add_mesh(test::square(0.1f));
  uint32_t solid = scene.add_material({.material = std::make_shared<test::Lambert>(0.5f)});
  uint32_t thin = scene.add_material({.material = std::make_shared<Veil>()});

  std::optional<uint32_t> around() {
    scene.set_camera(Camera::look_at({0.1f, 0.2f, 0.1f}, {2, 0, 0}, {0, 0, 1}, 0.8f, 1));
    scene.commit(1);
    return surrounding_instance(scene);
  }
};

TEST(Surroundings, NamesWhatTheCameraIsInsideOf) {
  Room room;
  room.scene.add_instance(room.ball, test::shift({9, 0, 0}), {room.solid});
  room.scene.add_instance(room.ball, Affine{}, {room.solid});
  EXPECT_EQ(room.around(), 1u);
}

TEST(Surroundings, ACameraOutsideIsInsideOfNothing) {
  Room room;
  room.scene.add_instance(room.ball, test::shift({5, 0, 0}), {room.solid});
  EXPECT_EQ(room.around(), std::nullopt);
}

TEST(Surroundings, MirroredObjectsKeepTheirInside) {
  Room room;
  room.scene.add_instance(room.ball, test::shift({0, 0, 0}, {-1, 1, 1}), {room.solid});
  EXPECT_EQ(room.around(), 0u);
}

TEST(Surroundings, ARoomWithSomethingInViewIsARoom) {
  Room room;
  room.scene.add_instance(room.ball, Affine{}, {room.solid});
  room.scene.add_instance(room.floor, test::shift({0.4f, 0.15f, 0}), {room.solid});
  EXPECT_EQ(room.around(), std::nullopt);
}

TEST(Surroundings, APlaneSeenFromBehindSurroundsNothing) {
  Room room;
  const Affine wall{{0, 0, 1, 0.9f, 0, 99, 0, 0, 99, 0, 0, 0}};
  room.scene.add_instance(room.floor, wall, {room.solid});
  EXPECT_EQ(room.around(), std::nullopt);
}

TEST(Surroundings, LooksThroughWhatIsHiddenFromTheCamera) {
  Room room;
  room.scene.add_instance(room.ball, test::shift({0, 0, 0}, Vec3(0.8f)), {room.solid}, {}, hidden::kFromCamera);
  EXPECT_EQ(room.around(), std::nullopt);
  room.scene.add_instance(room.ball, Affine{}, {room.solid});
  EXPECT_EQ(room.around(), 1u);
}

TEST(Surroundings, WhatLetsLightThroughDoesNotCount) {
  Room room;
  room.scene.add_instance(room.ball, Affine{}, {room.thin});
  EXPECT_EQ(room.around(), std::nullopt);
}

}  // namespace
}  // namespace velour::surroundings_test
