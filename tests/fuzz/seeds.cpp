// Writes what every target's corpus starts from: fuzz_seeds FOLDER  ->  FOLDER/TARGET/NAME
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "target.hpp"

std::size_t trocar::fuzz::plain_mutation(std::uint8_t*, std::size_t size, std::size_t) { return size; }

/// As libFuzzer's dictionaries want it.
static std::string quoted(const std::string& word) {
  std::string out = "\"";
  for (const char c : word) {
    char hex[8];
    std::snprintf(hex, sizeof hex, "\\x%02x", unsigned(static_cast<unsigned char>(c)));
    out += hex;
  }
  return out + '"';
}

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n"), 2;
  for (const trocar::fuzz::Target& target : trocar::fuzz::targets()) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / target.name;
    std::filesystem::create_directories(folder);
    for (const trocar::fuzz::Seed& seed : target.seeds()) {
      const auto* bytes = reinterpret_cast<const char*>(seed.bytes.data());
      std::ofstream(folder / ("seed-" + seed.name), std::ios::binary)
          .write(bytes, std::streamsize(std::min(seed.bytes.size(), target.longest)));
    }
    std::ofstream dictionary(std::filesystem::path(argv[1]) / (std::string(target.name) + ".dict"));
    if (target.words)
      for (const std::string& word : target.words()) dictionary << quoted(word) << '\n';
    std::printf("%s %zu\n", target.name, target.longest);
  }
}
