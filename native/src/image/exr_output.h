// OpenEXR output stream into an AtomicFile.
#pragma once

#include <OpenEXR/ImfIO.h>

#include <string>

#include "file/atomic_file.h"

namespace velour {

class ExrOutput : public Imf::OStream {
 public:
  ExrOutput(AtomicFile& file, const std::string& path) : OStream(path.c_str()), file_(file) {}
  void write(const char source[], int count) override {
    file_.write({reinterpret_cast<const uint8_t*>(source), static_cast<size_t>(count)});
  }
  uint64_t tellp() override { return file_.position(); }
  void seekp(uint64_t position) override { file_.seek(position); }

 private:
  AtomicFile& file_;
};

}  // namespace velour
