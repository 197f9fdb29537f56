// The shipped pelvis under wild hands for longer than the quick test has time for.
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>

#include "wild_hands.hpp"

TEST(GynaecologySoak, BearsWildHands) {
  using namespace trocar;
  wild::bear_wild_hands(scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json")), 16000);
}
