#include "usb_link.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/usb/ch9.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

namespace accrete::vm {
namespace {

// Twelve words in network order, the same size for every message:
// command, sequence, device, direction, endpoint, flags or status, length, ..., and the set-up packet in the last two.
using Message = std::array<std::uint32_t, 12>;
enum Word : std::uint8_t { kCommand, kSequence, kDevice, kDirection, kEndpoint, kStatus, kLength, kSetup = 10 };
enum Command : std::uint8_t { kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinked = 4 };

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

bool read_all(int socket, void* to, std::size_t size) {
  return size == 0 || recv(socket, to, size, MSG_WAITALL) == static_cast<ssize_t>(size);
}

}  // namespace

UsbLink::UsbLink(int port) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("socketpair");
  socket_ = ends[0];
  const int attach = open("/sys/devices/platform/vhci_hcd.0/attach", O_WRONLY | O_CLOEXEC);
  // port, socket, number of the device on its bus (any), speed
  const std::string line = std::to_string(port) + " " + std::to_string(ends[1]) + " " + std::to_string(port + 1) + " " +
                           std::to_string(USB_SPEED_HIGH);
  const bool attached = attach >= 0 && write(attach, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const int error = errno;
  close(attach);
  close(ends[1]);
  if (attached) return;
  close(socket_);
  errno = error;
  fail("vhci_hcd's attach");
}

UsbLink::~UsbLink() {
  shutdown(socket_, SHUT_RDWR);
  close(socket_);
}

bool UsbLink::receive(UsbRequest& request) {
  Message m{};
  if (!read_all(socket_, m.data(), sizeof m)) return false;
  std::memcpy(request.setup.data(), &m[kSetup], request.setup.size());
  for (std::uint32_t& word : m) word = ntohl(word);
  request.unlink = m[kCommand] == kUnlink;
  request.sequence = m[kSequence];
  request.unlinked = m[kStatus];  // the same place
  request.endpoint = m[kEndpoint];
  request.in = m[kDirection] != 0;
  request.length = m[kLength];
  request.data.resize(request.unlink || request.in ? 0 : request.length);
  return read_all(socket_, request.data.data(), request.data.size());
}

bool UsbLink::answer(std::uint32_t command, std::uint32_t sequence, int status, std::uint32_t length,
                     std::span<const std::uint8_t> header, std::span<const std::uint8_t> rest) {
  Message m{};
  m[kCommand] = htonl(command);
  m[kSequence] = htonl(sequence);
  m[kStatus] = htonl(static_cast<std::uint32_t>(status));
  m[kLength] = htonl(length);
  message_.resize(sizeof m);
  std::memcpy(message_.data(), m.data(), sizeof m);
  message_.insert(message_.end(), header.begin(), header.end());
  message_.insert(message_.end(), rest.begin(), rest.end());
  for (std::size_t sent = 0; sent < message_.size();) {
    const ssize_t n = send(socket_, message_.data() + sent, message_.size() - sent, MSG_NOSIGNAL);
    if (n < 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

bool UsbLink::send_data(std::uint32_t sequence, std::span<const std::uint8_t> header,
                        std::span<const std::uint8_t> rest) {
  return answer(kSubmitted, sequence, 0, static_cast<std::uint32_t>(header.size() + rest.size()), header, rest);
}

bool UsbLink::accept_data(std::uint32_t sequence, std::uint32_t length) {
  return answer(kSubmitted, sequence, 0, length, {}, {});
}

bool UsbLink::refuse(std::uint32_t sequence) { return answer(kSubmitted, sequence, -EPIPE, 0, {}, {}); }

bool UsbLink::confirm_unlink(std::uint32_t sequence, bool was_pending) {
  return answer(kUnlinked, sequence, was_pending ? -ECONNRESET : 0, 0, {}, {});
}

}  // namespace accrete::vm
