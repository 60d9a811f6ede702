// The state of a pipeline as a file, and back: written by one list of members, checked as a whole before it is taken
// up.
#include "accrete/saved_model.h"

#include <bit>
#include <cmath>

#include "accumulator/checksum.h"
#include "accumulator/pipeline.h"
#include "accumulator/saved_state.h"
#include "math/cholesky.h"

namespace accrete {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {'a', 'c', 'c', 'r', 'e', 't', 'e', 0x1a};  // 0x1a: no text file
constexpr std::uint32_t kFormat = 1;
constexpr std::size_t kChecksumBytes = 8;  // at the end, of all before

struct Header {
  std::array<std::uint8_t, 8> magic = kMagic;
  std::uint32_t format = kFormat;
  std::uint32_t byte_order = 0x01020304;
  std::uint64_t layout = 0;
  std::uint64_t size = 0;  // of the whole file
  std::uint64_t image_width = 0, image_height = 0, primitives2d = 0, primitives3d = 0, stereo_matches = 0;
  std::uint32_t primitives = 0;  // in use
};

template <class Archive>
void fields(Archive& a, Header& h) {
  members(a, h.magic, h.format, h.byte_order, h.layout, h.size, h.image_width, h.image_height, h.primitives2d,
          h.primitives3d, h.stereo_matches, h.primitives);
}

template <class T>
std::size_t bytes_of() {
  ByteCounter counter;
  T object{};
  members(counter, object);
  return counter.count;
}

std::uint64_t layout() {
  LayoutMark mark;
  Header header;
  SavedHead head;
  SavedPrimitive primitive;
  members(mark, header, head, primitive);
  mark.mix(SeenDirections::kBins);
  return mark.mark;
}

std::size_t image_bytes(const SavedHead& head) {
  return std::size_t{head.width_px[0]} * head.height_px[0] + std::size_t{head.width_px[1]} * head.height_px[1];
}

std::size_t size_of(const SavedHead& head, std::size_t slots) {
  return bytes_of<Header>() + bytes_of<SavedHead>() + slots * sizeof(std::uint32_t)  // generations
         + head.free_count * sizeof(std::uint32_t) +
         (slots - head.free_count) * (sizeof(std::uint32_t) + bytes_of<SavedPrimitive>()) + image_bytes(head) +
         kChecksumBytes;
}

template <int N, std::size_t kPacked>
bool is_covariance(const std::array<float, kPacked>& packed) {
  Symmetric<float, N> a;
  static_assert(Symmetric<float, N>::kSize == kPacked);
  for (std::size_t i = 0; i < kPacked; ++i) a.v[i] = packed[i];
  Symmetric<float, N> factor;
  float inverse[N];
  return cholesky<N>(a, factor, inverse);
}

// Could a run have ended with this primitive? Numbers are finite already.
bool is_possible(const SavedPrimitive& p, const SavedHead& head) {
  const Track& t = p.track;
  const auto& q = p.geometry.quaternion;
  const float norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return (t.state == State::kTentative || t.state == State::kConfirmed || t.state == State::kPreserved) &&
         t.first_frame <= t.last_frame && t.last_frame <= head.frame && t.visible >= 0 && t.visible <= 1 &&
         std::abs(norm2 - 1) < 1e-3F && std::abs(p.appearance.mean.phase) <= 3.1416F &&
         is_covariance<6>(p.geometry.covariance) && is_covariance<7>(p.appearance.covariance);
}

// Of a file that is whole: what every reader sees first.
SavedModelFault read_header(std::span<const std::byte> bytes, Header& header) {
  ByteReader reader(bytes);
  members(reader, header);
  if (header.magic != kMagic) return SavedModelFault::kNoModel;
  if (!reader.good) return SavedModelFault::kCutOff;
  if (header.byte_order != Header{}.byte_order) return SavedModelFault::kOtherLayout;
  if (header.format != kFormat) return SavedModelFault::kOtherVersion;
  if (header.layout != layout()) return SavedModelFault::kOtherLayout;
  if (header.size != bytes.size() || bytes.size() < bytes_of<Header>() + kChecksumBytes)
    return SavedModelFault::kCutOff;
  std::uint64_t checksum = 0;
  ByteReader end(bytes.last(kChecksumBytes));
  end.value(checksum);
  return checksum == crc64(bytes.first(bytes.size() - kChecksumBytes)) ? SavedModelFault::kNone
                                                                       : SavedModelFault::kDamaged;
}

Status status_of(SavedModelFault fault) {
  switch (fault) {
    case SavedModelFault::kNone:
      return Status::kOk;
    case SavedModelFault::kNoModel:
    case SavedModelFault::kImpossible:
      return Status::kInvalidArgument;
    case SavedModelFault::kOtherVersion:
    case SavedModelFault::kOtherLayout:
      return Status::kUnsupported;
    case SavedModelFault::kOtherLimits:
      return Status::kCapacityExceeded;
    case SavedModelFault::kCutOff:
    case SavedModelFault::kDamaged:
      break;
  }
  return Status::kDataLoss;
}

}  // namespace

const char* to_string(SavedModelFault fault) {
  switch (fault) {
    case SavedModelFault::kNone:
      return "nothing is wrong";
    case SavedModelFault::kNoModel:
      return "this is no saved model";
    case SavedModelFault::kOtherVersion:
      return "it was saved in another version of the format: use the library that wrote it, or accumulate anew";
    case SavedModelFault::kOtherLayout:
      return "it was saved by a library whose state has other members, or on a machine with another byte order: use "
             "the "
             "library that wrote it, or accumulate anew";
    case SavedModelFault::kOtherLimits:
      return "it was saved with other capacities: use an accumulator with the same";
    case SavedModelFault::kCutOff:
      return "it does not have the length that it names: it was cut off, or something was added";
    case SavedModelFault::kDamaged:
      return "it is damaged: its checksum is another";
    case SavedModelFault::kImpossible:
      return "it holds a state in which no run ends: it was not written by this library";
  }
  return "unknown";
}

SavedModelFault read_saved_model_info(std::span<const std::byte> bytes, SavedModelInfo& info) {
  Header header;
  if (const SavedModelFault fault = read_header(bytes, header); fault != SavedModelFault::kNone) return fault;
  SavedHead head;
  ByteReader reader(bytes.subspan(bytes_of<Header>()));
  members(reader, head);
  info.capacities = {static_cast<std::size_t>(header.image_width), static_cast<std::size_t>(header.image_height),
                     static_cast<std::size_t>(header.primitives2d), static_cast<std::size_t>(header.primitives3d),
                     static_cast<std::size_t>(header.stereo_matches)};
  info.frames = head.frame;
  info.primitives = header.primitives;
  info.width_px = head.width_px[0];
  info.height_px = head.height_px[0];
  info.has_times = head.has_last;
  info.last = head.last_left;
  return SavedModelFault::kNone;
}

SavedHead Pipeline::saved_head() const {
  SavedHead head{frame_,
                 has_last_,
                 typical_misfit_,
                 last_left_,
                 last_right_,
                 last_motion_,
                 last_centres_,
                 {},
                 {},
                 static_cast<std::uint32_t>(store_.free_count)};
  for (int eye = 0; eye < 2; ++eye) {
    if (!has_previous_[eye]) continue;
    const Camera& camera = eye == 0 ? rig_.left : rig_.right;
    head.width_px[eye] = static_cast<std::uint32_t>(camera.width_px);
    head.height_px[eye] = static_cast<std::uint32_t>(camera.height_px);
  }
  return head;
}

std::size_t Pipeline::saved_bytes() const { return size_of(saved_head(), store_.tracks.size()); }

Status Pipeline::save(std::span<std::byte> to) const {
  if (!configured_) return Status::kUnavailable;
  SavedHead head = saved_head();
  Header header;
  header.layout = layout();
  header.size = size_of(head, store_.tracks.size());
  if (to.size() < header.size) return Status::kCapacityExceeded;
  header.image_width = capacities_.image_width;
  header.image_height = capacities_.image_height;
  header.primitives2d = capacities_.primitives2d;
  header.primitives3d = capacities_.primitives3d;
  header.stereo_matches = capacities_.stereo_matches;
  header.primitives = static_cast<std::uint32_t>(store_.size());
  ByteWriter writer(to);
  members(writer, header, head);
  for (const Track& track : store_.tracks) writer.value(track.generation);
  for (std::size_t i = 0; i < store_.free_count; ++i)
    writer.value(store_.free_slots[(store_.free_begin + i) % store_.free_slots.size()]);
  for (std::uint32_t slot = 0; slot < store_.tracks.size(); ++slot) {
    if (store_.tracks[slot].state == State::kFree) continue;
    SavedPrimitive primitive{store_.tracks[slot], load(store_.geometry[slot / kBlockLanes], slot % kBlockLanes),
                             load(store_.appearance[slot / kBlockLanes], slot % kBlockLanes)};
    members(writer, slot, primitive);
  }
  for (int eye = 0; eye < 2; ++eye)
    writer.bytes(w_.eye[eye].previous.first(std::size_t{head.width_px[eye]} * head.height_px[eye]));
  std::uint64_t checksum = crc64(to.first(writer.at));
  writer.value(checksum);
  return Status::kOk;
}

RestoreReport Pipeline::restore(std::span<const std::byte> from, RestoredClock clock) {
  if (!configured_) return {Status::kUnavailable, SavedModelFault::kNone};
  const auto refused = [](SavedModelFault fault) { return RestoreReport{status_of(fault), fault}; };
  Header header;
  if (const SavedModelFault fault = read_header(from, header); fault != SavedModelFault::kNone) return refused(fault);
  if (header.image_width != capacities_.image_width || header.image_height != capacities_.image_height ||
      header.primitives2d != capacities_.primitives2d || header.primitives3d != capacities_.primitives3d ||
      header.stereo_matches != capacities_.stereo_matches)
    return refused(SavedModelFault::kOtherLimits);

  // All is looked at before anything is changed. `scratch` marks the slots that were named.
  const std::size_t slots = store_.tracks.size();
  const ByteReader begin = [&] {
    ByteReader reader(from.first(from.size() - kChecksumBytes));
    members(reader, header);
    return reader;
  }();
  ByteReader reader = begin;
  SavedHead head;
  members(reader, head);
  const std::size_t area = capacities_.image_width * capacities_.image_height;
  const auto fits = [&](int eye) { return std::uint64_t{head.width_px[eye]} * head.height_px[eye] <= area; };
  if (head.free_count > slots || header.primitives != slots - head.free_count || !fits(0) || !fits(1) ||
      header.size != size_of(head, slots) || !(head.typical_misfit > 0))
    return refused(SavedModelFault::kImpossible);
  for (std::uint32_t& mark : store_.scratch) mark = 0;
  const auto name = [&](std::uint32_t slot) { return slot < slots && store_.scratch[slot]++ == 0; };
  reader.skip(slots * sizeof(std::uint32_t));  // generations may be any
  bool possible = reader.good;
  for (std::uint32_t i = 0; i < head.free_count && possible; ++i) {
    std::uint32_t slot = 0;
    reader.value(slot);
    possible = name(slot);
  }
  for (std::uint32_t i = 0; i < header.primitives && possible; ++i) {
    std::uint32_t slot = 0;
    SavedPrimitive primitive;
    members(reader, slot, primitive);
    possible = reader.good && name(slot) && is_possible(primitive, head);
  }
  if (!possible) return refused(SavedModelFault::kImpossible);

  reader = begin;
  members(reader, head);
  store_.clear();
  for (Track& track : store_.tracks) reader.value(track.generation);
  for (std::uint32_t i = 0; i < head.free_count; ++i) reader.value(store_.free_slots[i]);
  store_.free_begin = 0;
  store_.free_count = head.free_count;
  for (std::uint32_t i = 0; i < header.primitives; ++i) {
    std::uint32_t slot = 0;
    SavedPrimitive primitive;
    members(reader, slot, primitive);
    primitive.track.generation = store_.tracks[slot].generation;
    store_.tracks[slot] = primitive.track;
    accrete::store(primitive.geometry, store_.geometry[slot / kBlockLanes], slot % kBlockLanes);
    accrete::store(primitive.appearance, store_.appearance[slot / kBlockLanes], slot % kBlockLanes);
  }
  frame_ = head.frame;
  typical_misfit_ = head.typical_misfit;
  const bool goes_on = clock == RestoredClock::kGoesOn;
  has_last_ = head.has_last && goes_on;
  last_left_ = head.last_left;
  last_right_ = head.last_right;
  last_motion_ = head.last_motion;
  last_centres_ = head.last_centres;
  for (int eye = 0; eye < 2; ++eye) {
    const Camera& camera = eye == 0 ? rig_.left : rig_.right;
    const auto pixels = reader.bytes(std::size_t{head.width_px[eye]} * head.height_px[eye]);
    // Images of another size than this rig's are of no use.
    has_previous_[eye] = goes_on && !pixels.empty() &&
                         head.width_px[eye] == static_cast<std::uint32_t>(camera.width_px) &&
                         head.height_px[eye] == static_cast<std::uint32_t>(camera.height_px);
    if (has_previous_[eye]) std::memcpy(w_.eye[eye].previous.data(), pixels.data(), pixels.size());
  }
  count_[0] = count_[1] = match_count_ = live_count_ = expected_count_ = 0;
  return {};
}

}  // namespace accrete
