#include "motion/line_input.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "text/parse.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

constexpr std::size_t kLargestDatagram = 65536;
constexpr int kNoWriterPoll_ms = 10;  // a FIFO without a writer reports its end over and over

std::string reason() { return std::strerror(errno); }

bool parse_port(std::string_view text, std::int64_t& port) { return parse(text, port) && port >= 0 && port <= 65535; }

}  // namespace

LineInput::~LineInput() {
  if (fd_ > STDERR_FILENO) ::close(fd_);
  for (const int end : wake_)
    if (end >= 0) ::close(end);
}

Outcome LineInput::open(const std::string& where) {
  if (::pipe2(wake_, O_CLOEXEC | O_NONBLOCK) != 0)
    return {Status::kUnavailable, "live poses: no pipe to be had: " + reason() + "; close other programs"};
  buffer_.resize(kLargestDatagram);
  name_ = "poses from " + where;
  if (where == "-") {
    kind_ = Kind::kStandardInput;
    name_ = "poses from standard input";
    fd_ = STDIN_FILENO;
    return {};
  }
  if (where.starts_with("fifo:")) return open_fifo(where.substr(5));
  if (where.starts_with("udp:")) return open_udp(where.substr(4));
  return {Status::kInvalidArgument,
          where + " is no stream of poses: give - (standard input), fifo:PATH, udp:PORT or udp:HOST:PORT"};
}

Outcome LineInput::open_fifo(const std::string& path) {
  kind_ = Kind::kFifo;
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    return {Status::kNotFound, path + ": " + reason() + ": make it first (mkfifo " + path + ")"};
  if (!S_ISFIFO(status.st_mode))
    return {Status::kInvalidArgument, path + " is no FIFO: make one (mkfifo), or read a file of poses (--poses FILE)"};
  fd_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) return {Status::kUnavailable, path + " cannot be read: " + reason() + "; check its permissions"};
  return {};
}

Outcome LineInput::open_udp(const std::string& address) {
  kind_ = Kind::kUdp;
  const std::size_t colon = address.rfind(':');
  std::string host = colon == std::string::npos ? "127.0.0.1" : address.substr(0, colon);
  const std::string port_text = colon == std::string::npos ? address : address.substr(colon + 1);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  std::int64_t port = 0;
  if (!parse_port(port_text, port) || host.empty())
    return {Status::kInvalidArgument, "udp:" + address + ": give udp:PORT or udp:HOST:PORT, a port of 0 to 65535"};
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), port_text.c_str(), &hints, &found); error != 0)
    return {Status::kNotFound, "udp:" + address + ": " + ::gai_strerror(error) + ": give an address of this machine"};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> guard(found, ::freeaddrinfo);
  fd_ = ::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd_ < 0 || ::bind(fd_, found->ai_addr, found->ai_addrlen) != 0)
    return {Status::kUnavailable,
            "udp:" + address + ": " + reason() + ": choose another port, or an address of this machine"};
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  std::array<char, 16> service{};
  std::int64_t got = 0;
  if (::getsockname(fd_, reinterpret_cast<sockaddr*>(&bound), &size) == 0 &&
      ::getnameinfo(reinterpret_cast<sockaddr*>(&bound), size, nullptr, 0, service.data(), service.size(),
                    NI_NUMERICSERV | NI_DGRAM) == 0 &&
      parse(service.data(), got))
    port_ = static_cast<int>(got);
  return {};
}

void LineInput::stop() {
  const char byte = 0;
  [[maybe_unused]] const auto written = ::write(wake_[1], &byte, 1);  // full: it is awake already
}

bool LineInput::wait() {
  std::array<pollfd, 2> fds{{{wake_[0], POLLIN, 0}, {fd_, POLLIN, 0}}};
  const int n = ::poll(fds.data(), no_writer_ ? 1 : 2, no_writer_ ? kNoWriterPoll_ms : -1);
  return (n >= 0 || errno == EINTR) && fds[0].revents == 0;
}

bool LineInput::read_some(const Listener& listener) {
  const ssize_t n = kind_ == Kind::kUdp ? ::recv(fd_, buffer_.data(), buffer_.size(), 0)
                                        : ::read(fd_, buffer_.data(), buffer_.size());
  if (n < 0) {
    if (errno == EAGAIN || errno == EINTR || errno == ECONNREFUSED) return true;
    return false;
  }
  if (n == 0 && kind_ == Kind::kStandardInput) return false;
  if (n > 0) splitter_.feed({buffer_.data(), static_cast<std::size_t>(n)}, listener.line);
  if (kind_ == Kind::kUdp) splitter_.end(listener.line);  // a datagram is whole
  if (kind_ == Kind::kFifo) {
    if (n == 0 && !no_writer_) {
      splitter_.end(listener.line);  // the next writer does not complete the line of the last one
      listener.interrupted();
    }
    no_writer_ = n == 0;
  }
  return true;
}

void LineInput::run(const Listener& listener) {
  while (wait())
    if (!read_some(listener)) {
      splitter_.end(listener.line);
      break;
    }
  listener.ended();
}

}  // namespace accrete::hal
