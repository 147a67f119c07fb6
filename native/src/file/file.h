// Reads whole files up to a limit, writes them atomically, and hashes them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "job/progress.h"

namespace velour {

/// All bytes of `path`. Throws Error(io) if it cannot be read, Error(bad_data) if it is larger than `limit` bytes.
std::vector<uint8_t> read_file(const std::string& path, uint64_t limit = uint64_t{8} << 30);

/// The first `count` bytes (fewer when the file is shorter).
std::vector<uint8_t> read_file_head(const std::string& path, size_t count);

/// Writes atomically: a killed process leaves the old file or the new one (file/atomic_file.h).
void write_file(const std::string& path, std::span<const uint8_t> bytes);

/// SHA-256 in lower-case hexadecimal.
std::string sha256_hex(std::span<const uint8_t> bytes);

/// SHA-256 of a file, read a megabyte at a time.
std::string sha256_of_file(const std::string& path, const Progress& progress = Progress());

}  // namespace velour
