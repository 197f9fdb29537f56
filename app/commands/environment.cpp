#include "commands/environment.hpp"

#include <cstdlib>

#include <trocar/core/decimal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {
namespace {

constexpr int kMostThreads = 64;

constexpr EnvironmentVariable kVariables[] = {
    {"TROCAR_SCENES", "the folder of scenes that come with the program; default: beside the program"},
    {"TROCAR_DATA",
     "the user's data: settings, sessions, recordings, own scenes; default: $XDG_DATA_HOME/trocar, "
     "else ~/.local/share/trocar"},
    {"TROCAR_LIBRARY", "further folders, separated by ':', whose files a scene or exercise may name; default: none"},
    {"TROCAR_CACHE", "computed solvers; default: $XDG_CACHE_HOME/trocar, else ~/.cache/trocar"},
    {"TROCAR_THREADS", "number of threads, 1 to 64; default: the number of cores, less one"},
    {"TROCAR_SIMD",
     "instruction set of the kernels: avx512, avx2, sse2 or generic; default: the widest of the machine"},
    {"TROCAR_TOKEN", "the token of a team, as --token of train and join; default: none"},
    {"TROCAR_CAD", "the program that reads STEP and IGES files; default: trocar_cad beside the program"},
    {"TROCAR_GAMEPAD", "a simulated gamepad, for tests of the window; default: none"},
    {"TROCAR_WINDOW_LOG", "a file for events of the window as JSON lines, as --log; default: none"},
};

}  // namespace

std::span<const EnvironmentVariable> environment_variables() { return kVariables; }

void check_environment() {
  const char* text = std::getenv("TROCAR_THREADS");
  if (!text) return;
  const std::optional<std::int64_t> threads = core::to_integer(text);
  if (!threads || *threads < 1 || *threads > kMostThreads)
    throw core::BadInput(
        {{{"TROCAR_THREADS", 0, 0}, tr("expected a whole number from 1 to {}, got '{}'", kMostThreads, text)}});
}

}  // namespace trocar::app
