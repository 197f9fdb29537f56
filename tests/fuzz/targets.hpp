// The targets' functions and what they share.
#pragma once

#include <trocar/scene/description/description.hpp>
#include <trocar/sim/stages/step.hpp>

#include "target.hpp"

namespace trocar::fuzz {

void scene_files(Bytes bytes);
std::vector<Seed> scene_seeds();
void scene_compiled(Bytes bytes);
std::vector<Seed> compile_seeds();
void exercise_file(Bytes bytes);
std::vector<Seed> exercise_seeds();
void recording_file(Bytes bytes);
std::vector<Seed> recording_seeds();
std::size_t mutate_recording(std::uint8_t* data, std::size_t size, std::size_t capacity, unsigned seed);
void waiting_file(Bytes bytes);
std::vector<Seed> waiting_seeds();
void motion_file(Bytes bytes);
std::vector<Seed> motion_seeds();
std::vector<std::string> motion_words();
void box_line(Bytes bytes);
std::vector<Seed> box_seeds();
void box_file(Bytes bytes);
std::vector<Seed> box_file_seeds();
void display_keyframe(Bytes bytes);
std::vector<Seed> display_seeds();

void settings_file(Bytes bytes);
std::vector<Seed> settings_seeds();
void trace_bytes(Bytes bytes);
std::vector<Seed> trace_seeds();
std::size_t mutate_trace(std::uint8_t* data, std::size_t size, std::size_t capacity, unsigned seed);
void trace_csv(Bytes bytes);
std::vector<Seed> trace_csv_seeds();
void tet_mesh_file(Bytes bytes);
std::vector<Seed> tet_mesh_seeds();
std::vector<std::string> tet_mesh_words();
void surface_file(Bytes bytes);
std::vector<Seed> surface_obj_seeds();
std::vector<Seed> surface_stl_seeds();
std::vector<Seed> surface_ply_seeds();
std::vector<Seed> surface_vtk_seeds();
std::vector<Seed> surface_gltf_seeds();
std::vector<std::string> surface_words();
void nrrd_file(Bytes bytes);
std::vector<Seed> nrrd_seeds();
std::vector<std::string> nrrd_words();
void volume_file(Bytes bytes);
std::vector<Seed> volume_nifti_seeds();
std::vector<Seed> volume_nrrd_seeds();
std::vector<Seed> volume_meta_seeds();
std::vector<Seed> volume_dicom_seeds();
std::vector<std::string> volume_words();
void dicom_folder(Bytes bytes);
std::vector<Seed> dicom_folder_seeds();
void team_message(Bytes bytes);
std::vector<Seed> team_seeds();
void tracker_stream(Bytes bytes);
std::vector<Seed> tracker_seeds();
void tracker_file(Bytes bytes);
std::vector<Seed> tracker_file_seeds();
void mechanism_file(Bytes bytes);
std::vector<Seed> mechanism_seeds();
void room_file(Bytes bytes);
std::vector<Seed> room_seeds();
void programme_file(Bytes bytes);
std::vector<Seed> programme_seeds();
void urdf_file(Bytes bytes);
std::vector<Seed> urdf_seeds();
std::vector<std::string> urdf_words();

/// So small that a compile takes milliseconds.
bool quick_to_compile(const scene::Description& description);
/// Hands wave over the scene for some ticks; what becomes not finite must be told.
void require_stepped(const sim::Model& model);
/// Every place in the State is a number.
bool finite(const sim::Model& model, const sim::State& state);

}  // namespace trocar::fuzz
