#include "base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "base/byte_reader.h"
#include "base/error.h"
#include "support/test_data.h"

namespace velour {
namespace fs = std::filesystem;
namespace {

std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Status status_of(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.status();
  }
  return Status::ok;
}

TEST(File, WritesAndReadsBack) {
  const std::string path = test::scratch_folder() / "a.bin";
  write_file(path, bytes_of("velour"));
  EXPECT_EQ(read_file(path), bytes_of("velour"));
  EXPECT_EQ(read_file_head(path, 3), bytes_of("vel"));
  EXPECT_EQ(read_file_head(path, 300), bytes_of("velour"));
  write_file(path, {});
  EXPECT_TRUE(read_file(path).empty());
}

TEST(File, LeavesNothingBesideTheFile) {
  const auto folder = test::scratch_folder();
  write_file(folder / "a.bin", bytes_of("one"));
  write_file(folder / "a.bin", bytes_of("two"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(File, KeepsALinkAndWritesItsTarget) {
  const auto folder = test::scratch_folder();
  write_file(folder / "target", bytes_of("old"));
  std::filesystem::create_symlink(folder / "target", folder / "link");
  write_file(folder / "link", bytes_of("new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_file(folder / "target"), bytes_of("new"));
}

TEST(File, SaysWhichFileAndWhy) {
  const auto folder = test::scratch_folder();
  const std::string missing = folder / "missing.bin";
  try {
    read_file(missing);
    FAIL() << "a missing file was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::io);
    EXPECT_NE(std::string(error.what()).find("missing.bin"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos);
  }
}

TEST(File, RefusesWhatIsNoRegularFile) {
  const auto folder = test::scratch_folder();
  EXPECT_EQ(status_of([&] { read_file(folder); }), Status::io);
  EXPECT_EQ(status_of([&] { read_file("/dev/zero"); }), Status::io);
  EXPECT_EQ(status_of([&] { write_file("/dev/null", {}); }), Status::io);
  EXPECT_EQ(status_of([&] { write_file(folder, {}); }), Status::io);
  EXPECT_EQ(status_of([&] { write_file(folder / "no" / "such" / "folder", {}); }), Status::io);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(File, HoldsTheLimit) {
  const std::string path = test::scratch_folder() / "a.bin";
  write_file(path, bytes_of("123456"));
  EXPECT_EQ(status_of([&] { read_file(path, 5); }), Status::bad_data);
  EXPECT_EQ(status_of([&] { read_file(path, 6); }), Status::ok);
}

TEST(Sha256, KnownAnswers) {  // FIPS 180-4 examples
  EXPECT_EQ(sha256_hex({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex(bytes_of("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(ByteReader, NeverLeavesTheBytes) {
  const std::vector<uint8_t> bytes{1, 0, 0, 0, 'a', 'b', 0, 9};
  ByteReader in(bytes, "file");
  EXPECT_EQ(in.number<uint32_t>("n"), 1u);
  EXPECT_EQ(in.text(2, "t"), "ab");
  EXPECT_EQ(in.remaining(), 1u);
  EXPECT_EQ(status_of([&] { in.number<uint32_t>("n"); }), Status::bad_data);
  EXPECT_EQ(status_of([&] { in.take(~uint64_t{0}, "n"); }), Status::bad_data);
  EXPECT_EQ(status_of([&] { in.seek(9, "n"); }), Status::bad_data);
  EXPECT_EQ(status_of([&] { in.text(255, "t"); }), Status::bad_data);
  in.seek(4, "t");
  EXPECT_EQ(status_of([&] { in.text(1, "t"); }), Status::bad_data);
}

TEST(AtomicFile, WritesAndSeeks) {
  const auto folder = test::scratch_folder();
  const std::string path = folder / "a.bin";
  {
    AtomicFile file(path);
    file.write(std::vector<uint8_t>(3'000'000, 7));  // more than is kept before it is written
    file.write(bytes_of("end"));
    EXPECT_EQ(file.position(), 3'000'003u);
    file.seek(10);
    file.write(bytes_of("here"));
    EXPECT_EQ(file.position(), 14u);
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
  }
  const std::vector<uint8_t> bytes = read_file(path);
  ASSERT_EQ(bytes.size(), 3'000'003u);
  EXPECT_EQ(std::string(bytes.begin() + 9, bytes.begin() + 15), "\x07here\x07");
  EXPECT_EQ(bytes.back(), 'd');
  EXPECT_EQ(sha256_of_file(path), sha256_hex(bytes));
}

TEST(AtomicFile, WithoutACommitNothingRemains) {
  const auto folder = test::scratch_folder();
  write_file(folder / "a.bin", bytes_of("old"));
  { AtomicFile(folder / "a.bin").write(bytes_of("new")); }
  EXPECT_EQ(read_file(folder / "a.bin"), bytes_of("old"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(AtomicFile, DoesNotStumbleOverWhatAKilledProcessHasLeft) {
  const auto folder = test::scratch_folder();
  const std::string path = folder / "a.bin";
  // As a process with the same number names its files, in another container, or before a restart of the machine.
  for (int i = 0; i < 64; ++i) {
    std::ofstream(path + ".velour-" + std::to_string(::getpid()) + "-" + std::to_string(i)) << "left";
  }
  write_file(path, bytes_of("new"));
  EXPECT_EQ(read_file(path), bytes_of("new"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 65);
}

/// Old files that nobody has locked go. Files of living processes, and files of the user with similar names, stay.
TEST(AtomicFile, RemovesWhatAKilledProcessHasLeft) {
  const auto folder = test::scratch_folder();
  const auto make = [&](const std::string& name, int seconds_old) {
    std::ofstream(folder / name) << "left";
    fs::last_write_time(folder / name, fs::file_time_type::clock::now() - std::chrono::seconds(seconds_old));
  };
  make("other.bin.velour-partial-1-2", 3600);
  make("written.velour-partial-3-4", 3600);
  make("begun.velour-partial-5-6", 0);
  make("mine.velour-20261127-1", 3600);
  const int writer = ::open((folder / "written.velour-partial-3-4").c_str(), O_RDONLY);
  ASSERT_EQ(::flock(writer, LOCK_EX | LOCK_NB), 0);
  write_file(folder / "a.bin", bytes_of("new"));
  ::close(writer);
  EXPECT_FALSE(fs::exists(folder / "other.bin.velour-partial-1-2"));
  for (const char* kept : {"written.velour-partial-3-4", "begun.velour-partial-5-6", "mine.velour-20261127-1", "a.bin"})
    EXPECT_TRUE(fs::exists(folder / kept)) << kept;
}

/// A full disk: the reason is told, by commit() as well.
TEST(AtomicFile, TellsWhyAWriteFailed) {
  const auto folder = test::scratch_folder();
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit small { 1000000, before.rlim_max };
  std::string first, second;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  {
    AtomicFile file(folder / "a.bin");
    const auto sentence = [](const auto& call) {
      try {
        call();
      } catch (const Error& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    first = sentence([&] { file.write(std::vector<uint8_t>(3'000'000, 7)); });
    second = sentence([&] { file.commit(); });
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, ignored);
  EXPECT_NE(first.find("File too large"), std::string::npos) << first;
  EXPECT_EQ(second, first);
  EXPECT_TRUE(fs::is_empty(folder));
}

/// A pipe without a writer and a device: refused at once.
TEST(ReadFile, RefusesWhatIsNoRegularFile) {
  const std::string pipe = test::scratch_folder() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/zero"), std::string("/tmp")}) {
    EXPECT_EQ(status_of([&] { read_file(path); }), Status::io) << path;
    EXPECT_EQ(status_of([&] { read_file_head(path, 4); }), Status::io) << path;
    EXPECT_EQ(status_of([&] { RandomAccessFile{path}; }), Status::io) << path;
  }
}

TEST(RandomAccessFile, ReadsPartsAndNoMore) {
  const auto folder = test::scratch_folder();
  const std::string path = folder / "a.bin";
  write_file(path, bytes_of("velour"));
  const RandomAccessFile file(path);
  EXPECT_EQ(file.size(), 6u);
  std::vector<uint8_t> part(3);
  file.read(2, part);
  EXPECT_EQ(part, bytes_of("lou"));
  EXPECT_EQ(status_of([&] { file.read(4, part); }), Status::bad_data);
  EXPECT_EQ(status_of([&] { RandomAccessFile{folder}; }), Status::io);
  EXPECT_EQ(sha256_of_file(path), sha256_hex(bytes_of("velour")));
}

}  // namespace
}  // namespace velour
