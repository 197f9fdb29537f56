// Which device leads what: maps of devices and files of trackers, or every fault that they have.
#pragma once

#include <filesystem>

#include <trocar/core/json.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::app {

bool is_inputs_file(const scene::JsonValue& root);

/// @throws core::BadInput with all faults
Json describe_inputs(const std::filesystem::path& path, const scene::JsonValue& root);
void print_inputs(const Json& inputs);

}  // namespace trocar::app
