#include "sidestep/robot/fci/socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace sidestep::robot::fci {
namespace {

constexpr std::uint32_t kLargestMessage = 1 << 16;  // of TCP; real ones have some 500 bytes

std::string Endpoint(const std::string& address, std::uint16_t port) {
  return address + ":" + std::to_string(port);
}

std::string Reason() { return std::strerror(errno); }

sockaddr_in SocketAddress(const std::string& address, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  if (inet_pton(AF_INET, address.c_str(), &result.sin_addr) != 1) {
    throw LinkError("'" + address + "' is no IPv4 address, such as 127.0.0.1");
  }
  return result;
}

Descriptor MakeSocket(int type) {
  Descriptor socket(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) throw LinkError("no socket: " + Reason());
  return socket;
}

void Bind(const Descriptor& socket, const std::string& address, std::uint16_t port) {
  const sockaddr_in where = SocketAddress(address, port);
  if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&where), sizeof(where)) != 0) {
    throw LinkError(Endpoint(address, port) + ": " + Reason());
  }
}

void SetOption(const Descriptor& socket, int level, int option, int value) {
  setsockopt(socket.get(), level, option, &value, sizeof(value));
}

std::string AddressText(const sockaddr_in& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address.sin_addr, text.data(), text.size());
  return text.data();
}

bool WaitFor(int fd, short events, std::chrono::microseconds at_most) {
  pollfd waiting{fd, events, 0};
  const timespec time{static_cast<time_t>(at_most.count() / 1'000'000),
                      static_cast<long>(at_most.count() % 1'000'000 * 1000)};
  return ppoll(&waiting, 1, &time, nullptr) > 0;
}

}  // namespace

Descriptor::Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}
Descriptor::~Descriptor() {
  if (fd_ >= 0) close(fd_);
}

bool WaitToRead(const std::vector<int>& descriptors, std::chrono::microseconds at_most) {
  std::vector<pollfd> waiting;
  for (const int fd : descriptors) waiting.push_back({fd, POLLIN, 0});
  at_most = std::max(at_most, std::chrono::microseconds(0));
  const timespec time{static_cast<time_t>(at_most.count() / 1'000'000),
                      static_cast<long>(at_most.count() % 1'000'000 * 1000)};
  return ppoll(waiting.data(), waiting.size(), &time, nullptr) > 0;
}

ByteStream ByteStream::Connect(const std::string& address, std::uint16_t port,
                               std::chrono::milliseconds at_most) {
  Descriptor socket = MakeSocket(SOCK_STREAM);
  const sockaddr_in where = SocketAddress(address, port);
  int error = 0;
  if (connect(socket.get(), reinterpret_cast<const sockaddr*>(&where), sizeof(where)) != 0) {
    error = errno;
    if (error == EINPROGRESS) {
      error = ETIMEDOUT;
      socklen_t size = sizeof(error);
      if (WaitFor(socket.get(), POLLOUT, at_most)) {
        getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size);
      }
    }
  }
  if (error != 0) throw LinkError(Endpoint(address, port) + ": " + std::strerror(error));
  SetOption(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  return {std::move(socket), address};
}

void ByteStream::Send(const Bytes& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count =
        send(socket_.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN) {
      if (!WaitFor(socket_.get(), POLLOUT, std::chrono::seconds(1))) {
        throw LinkClosed("the peer takes no more");
      }
    } else if (errno != EINTR) {
      throw LinkClosed("the connection is closed: " + Reason());
    }
  }
}

bool ByteStream::Receive(Bytes* bytes) {
  std::array<std::uint8_t, 1 << 16> buffer;
  for (;;) {
    const ssize_t count = recv(socket_.get(), buffer.data(), buffer.size(), 0);
    if (count > 0) {
      bytes->insert(bytes->end(), buffer.begin(), buffer.begin() + count);
      return true;
    }
    if (count == 0) throw LinkClosed("the peer has closed the connection");
    if (errno == EAGAIN) return false;
    if (errno != EINTR) throw LinkClosed("the connection is closed: " + Reason());
  }
}

void CommandLink::Send(const Message& message) {
  const Header header{message.request, message.id,
                      static_cast<std::uint32_t>(sizeof(Header) + message.payload.size())};
  Bytes bytes(header.size);
  std::memcpy(bytes.data(), &header, sizeof(Header));
  std::copy(message.payload.begin(), message.payload.end(), bytes.begin() + sizeof(Header));
  stream_.Send(bytes);
}

std::optional<Message> CommandLink::Receive() {
  for (;;) {
    if (pending_.size() >= sizeof(Header)) {
      Header header;
      std::memcpy(&header, pending_.data(), sizeof(Header));
      if (header.size < sizeof(Header) || header.size > kLargestMessage ||
          static_cast<std::uint32_t>(header.request) >= kNumRequests) {
        throw LinkError("the peer does not speak this protocol");
      }
      if (pending_.size() >= header.size) {
        const auto begin = pending_.begin();
        Message message{header.request, header.id,
                        Bytes(begin + sizeof(Header), begin + header.size)};
        pending_.erase(begin, begin + header.size);
        return message;
      }
    }
    if (!stream_.Receive(&pending_)) return std::nullopt;
  }
}

Listener::Listener(const std::string& address, std::uint16_t port)
    : socket_(MakeSocket(SOCK_STREAM)) {
  SetOption(socket_, SOL_SOCKET, SO_REUSEADDR, 1);
  Bind(socket_, address, port);
  if (listen(socket_.get(), 1) != 0) throw LinkError(Endpoint(address, port) + ": " + Reason());
}

std::optional<ByteStream> Listener::Accept() {
  sockaddr_in from{};
  socklen_t size = sizeof(from);
  Descriptor socket(accept4(socket_.get(), reinterpret_cast<sockaddr*>(&from), &size,
                            SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!socket.is_open()) return std::nullopt;
  SetOption(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  return ByteStream(std::move(socket), AddressText(from));
}

DatagramPort::DatagramPort(const std::string& address) : socket_(MakeSocket(SOCK_DGRAM)) {
  Bind(socket_, address, 0);
}

std::uint16_t DatagramPort::port() const {
  sockaddr_in own{};
  socklen_t size = sizeof(own);
  getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&own), &size);
  return ntohs(own.sin_port);
}

void DatagramPort::SetPeer(const std::string& address, std::uint16_t port) {
  const sockaddr_in peer = SocketAddress(address, port);
  peer_address_ = peer.sin_addr.s_addr;
  peer_port_ = peer.sin_port;
}

void DatagramPort::Send(const Bytes& bytes) {
  sockaddr_in peer{};
  peer.sin_family = AF_INET;
  peer.sin_port = peer_port_;
  peer.sin_addr.s_addr = peer_address_;
  sendto(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&peer), sizeof(peer));
}

std::optional<Bytes> DatagramPort::Receive(std::size_t size) {
  Bytes bytes(size + 1);  // one more, to notice what is longer
  for (;;) {
    sockaddr_in from{};
    socklen_t from_size = sizeof(from);
    const ssize_t count = recvfrom(socket_.get(), bytes.data(), bytes.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from), &from_size);
    if (count < 0) {
      if (errno == EINTR || errno == ECONNREFUSED) continue;
      return std::nullopt;
    }
    if (peer_address_ == 0) {
      peer_address_ = from.sin_addr.s_addr;
      peer_port_ = from.sin_port;
    }
    const bool is_of_peer = from.sin_addr.s_addr == peer_address_ && from.sin_port == peer_port_;
    if (!is_of_peer || static_cast<std::size_t>(count) != size) continue;
    bytes.resize(size);
    return bytes;
  }
}

}  // namespace sidestep::robot::fci
