// trocar report --trace: the motion of attempts as tables that `trocar trials` reads.
#pragma once

#include <filesystem>
#include <optional>

#include <trocar/training/metrics/trace_csv.hpp>
#include <trocar/training/store/store.hpp>

namespace trocar::app {

/// A recording's motion, from its inputs simulated again. Takes as long as the simulation.
/// @throws core::BadInput where another version of physics or scene made it
training::Trace trace_of_recording(const std::filesystem::path& recording);

/// Whose motion a table says that it is: the name, or a fixed alias of it.
training::TraceOrigin origin_of(const training::Attempt& attempt, bool names);

/// NUMBER.csv of every attempt whose motion the store knows. @return how many
int write_traces(const training::Store& store, const std::string& trainee, bool names,
                 const std::filesystem::path& folder);

/// @throws core::EnvironmentLacks
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace trocar::app
