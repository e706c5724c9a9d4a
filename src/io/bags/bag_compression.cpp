#include "bag_compression.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace coast::io {

namespace {

/// What one step of a decompressor did.
struct UnpackStep {
  enum class State { kGoesOn, kEnd, kFailed };
  State state = State::kGoesOn;
  std::size_t read = 0, written = 0;
};

/// Steps through the packed bytes until their end.
/// @param step  called with input, output and its size
template <class Step>
bool unpack_in_steps(std::string_view packed, std::size_t most, std::string& to, Step&& step) {
  constexpr std::size_t kFirst = std::size_t{1} << 16;
  std::size_t used = 0;
  to.resize(std::min(most, std::max(kFirst, 4 * packed.size())));
  while (true) {
    const UnpackStep done = step(packed, to.data() + used, to.size() - used);
    used += done.written;
    packed.remove_prefix(done.read);
    if (done.state == UnpackStep::State::kFailed) return false;
    if (done.state == UnpackStep::State::kEnd) break;
    if (used < to.size()) {
      if (done.read == 0 && done.written == 0) return false;  // it waits for bytes that are not there
    } else {
      if (used == most && done.read == 0 && done.written == 0) return false;  // larger
      to.resize(std::min(most, 2 * to.size()));
    }
  }
  to.resize(used);
  return true;
}

}  // namespace

bool unpack_bz2(std::string_view packed, std::size_t most, std::string& to) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return false;
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, &BZ2_bzDecompressEnd);
  return unpack_in_steps(packed, most, to, [&](std::string_view in, char* out, std::size_t size) -> UnpackStep {
    std::string input(in.substr(0, std::size_t{1} << 16));  // its interface does not take constant bytes
    stream.next_in = input.data();
    stream.avail_in = static_cast<unsigned>(input.size());
    stream.next_out = out;
    stream.avail_out = static_cast<unsigned>(size);
    const int status = BZ2_bzDecompress(&stream);
    const auto state = status == BZ_STREAM_END ? UnpackStep::State::kEnd
                       : status == BZ_OK       ? UnpackStep::State::kGoesOn
                                               : UnpackStep::State::kFailed;
    return {state, input.size() - stream.avail_in, size - stream.avail_out};
  });
}

bool unpack_lz4(std::string_view packed, std::size_t most, std::string& to) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return false;
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> end(context, &LZ4F_freeDecompressionContext);
  return unpack_in_steps(packed, most, to, [&](std::string_view in, char* out, std::size_t size) -> UnpackStep {
    std::size_t read = in.size(), written = size;
    const std::size_t hint = LZ4F_decompress(context, out, &written, in.data(), &read, nullptr);
    const auto state = LZ4F_isError(hint) != 0 ? UnpackStep::State::kFailed
                       : hint == 0             ? UnpackStep::State::kEnd
                                               : UnpackStep::State::kGoesOn;
    return {state, read, written};
  });
}

bool unpack_zstd(std::string_view packed, std::size_t most, std::string& to) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(), &ZSTD_freeDStream);
  if (!stream) return false;
  return unpack_in_steps(packed, most, to, [&](std::string_view in, char* out, std::size_t size) -> UnpackStep {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out, size, 0};
    const std::size_t hint = ZSTD_decompressStream(stream.get(), &output, &input);
    const bool ends = hint == 0 && input.pos == input.size;  // several frames may follow one another
    const auto state = ZSTD_isError(hint) != 0 ? UnpackStep::State::kFailed
                       : ends                  ? UnpackStep::State::kEnd
                                               : UnpackStep::State::kGoesOn;
    return {state, input.pos, output.pos};
  });
}

std::string pack_lz4(std::string_view content) {
  std::string packed(LZ4F_compressFrameBound(content.size(), nullptr), '\0');
  const std::size_t size = LZ4F_compressFrame(packed.data(), packed.size(), content.data(), content.size(), nullptr);
  if (LZ4F_isError(size) != 0) throw std::logic_error("an LZ4 frame is larger than its bound");
  packed.resize(size);
  return packed;
}

}  // namespace coast::io
