// Whole files: read with a bound, written atomically, hashed.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "job/progress.h"

namespace velour {

/// All bytes of `path`. Throws Error(io) when it cannot be read, Error(bad_data) when it is larger than `limit`.
std::vector<uint8_t> read_file(const std::string& path, uint64_t limit = uint64_t{8} << 30);

/// The first `count` bytes (fewer when the file is shorter).
std::vector<uint8_t> read_file_head(const std::string& path, size_t count);

/// A killed process leaves the old file or the new one (file/atomic_file.h).
void write_file(const std::string& path, std::span<const uint8_t> bytes);

/// Lower-case hex SHA-256.
std::string sha256_hex(std::span<const uint8_t> bytes);

/// The same of a file's bytes, a megabyte at a time.
std::string sha256_of_file(const std::string& path, const Progress& progress = Progress());

}  // namespace velour
