#include "targets.hpp"

#include <algorithm>

#include "json_mutation.hpp"

namespace trocar::fuzz {

std::span<const Target> targets() {
  static const Target all[] = {
      {"scene", scene_files, 50'000, scene_seeds, json_words, mutate_json, cross_json},
      {"compile", scene_compiled, 12'000, compile_seeds, json_words, mutate_json, cross_json},
      {"exercise", exercise_file, 8'000, exercise_seeds, json_words, mutate_json, cross_json},
      {"recording", recording_file, 20'000, recording_seeds, nullptr, mutate_recording},
      {"waiting", waiting_file, 8'000, waiting_seeds, json_words, mutate_json, cross_json},
      {"motion", motion_file, 4'000, motion_seeds, motion_words},
      {"box", box_line, 4'000, box_seeds},
      {"box_file", box_file, 8'000, box_file_seeds, json_words, mutate_json, cross_json},
      {"display", display_keyframe, 10'000, display_seeds},
      {"settings", settings_file, 4'000, settings_seeds, json_words, mutate_json, cross_json},
      {"trace", trace_bytes, 4'000, trace_seeds, nullptr, mutate_trace},
      {"trace_csv", trace_csv, 4'000, trace_csv_seeds},
      {"tet_mesh", tet_mesh_file, 4'000, tet_mesh_seeds, tet_mesh_words},
      {"surface_obj", surface_file, 2'000, surface_obj_seeds, surface_words},
      {"surface_stl", surface_file, 2'000, surface_stl_seeds, surface_words},
      {"surface_ply", surface_file, 2'000, surface_ply_seeds, surface_words},
      {"surface_vtk", surface_file, 2'000, surface_vtk_seeds, surface_words},
      {"surface_gltf", surface_file, 4'000, surface_gltf_seeds, surface_words},
      {"nrrd", nrrd_file, 2'000, nrrd_seeds, nrrd_words},
      {"volume_nifti", volume_file, 2'000, volume_nifti_seeds, volume_words},
      {"volume_nrrd", volume_file, 2'000, volume_nrrd_seeds, volume_words},
      {"volume_meta", volume_file, 2'000, volume_meta_seeds, volume_words},
      {"volume_dicom", volume_file, 3'000, volume_dicom_seeds, volume_words},
      {"dicom_folder", dicom_folder, 12'000, dicom_folder_seeds, volume_words},
      {"team", team_message, 4'000, team_seeds},
      {"tracker", tracker_stream, 4'000, tracker_seeds},
      {"tracker_file", tracker_file, 4'000, tracker_file_seeds, json_words, mutate_json, cross_json},
      {"mechanism", mechanism_file, 6'000, mechanism_seeds, json_words, mutate_json, cross_json},
      {"room", room_file, 6'000, room_seeds, json_words, mutate_json, cross_json},
      {"programme", programme_file, 4'000, programme_seeds, json_words, mutate_json, cross_json},
      {"urdf", urdf_file, 3'000, urdf_seeds, urdf_words},
  };
  return all;
}

const Target* find(std::string_view name) {
  const auto all = targets();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Target& t) { return t.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace trocar::fuzz
