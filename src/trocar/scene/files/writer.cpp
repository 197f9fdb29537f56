#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/writer.hpp>

namespace trocar::scene {

std::string write_scene(const Description& description) { return to_text(scene_file_keys().written(description)); }

}  // namespace trocar::scene
