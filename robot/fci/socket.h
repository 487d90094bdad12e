#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/robot/fci/wire.h"

namespace sidestep::robot::fci {

/// The network does not do what is wanted: nobody listens, the port is taken, the peer is gone.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// The peer has closed its end, or died.
class LinkClosed : public LinkError {
 public:
  using LinkError::LinkError;
};

/// A file descriptor that is closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  int get() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }

 private:
  int fd_;
};

/// Waits until one of them can be read, or the time is over. @return whether one can be.
bool WaitToRead(const std::vector<int>& descriptors, std::chrono::microseconds at_most);

/// A TCP connection: bytes, in order.
class ByteStream {
 public:
  /// @throws LinkError.
  static ByteStream Connect(const std::string& address, std::uint16_t port,
                            std::chrono::milliseconds at_most);
  ByteStream(Descriptor socket, std::string peer_address)
      : socket_(std::move(socket)), peer_address_(std::move(peer_address)) {}

  int fd() const { return socket_.get(); }
  const std::string& peer_address() const { return peer_address_; }

  /// All of them. @throws LinkClosed, also if the peer takes none for a second.
  void Send(const Bytes& bytes);
  /// Appends some that have arrived; does not wait. @return whether there were any.
  /// @throws LinkClosed.
  bool Receive(Bytes* bytes);

 private:
  Descriptor socket_;
  std::string peer_address_;
};

/// The TCP channel: whole messages of the protocol.
class CommandLink {
 public:
  /// @throws LinkError.
  static CommandLink Connect(const std::string& address, std::uint16_t port,
                             std::chrono::milliseconds at_most) {
    return CommandLink(ByteStream::Connect(address, port, at_most));
  }
  explicit CommandLink(ByteStream stream) : stream_(std::move(stream)) {}

  int fd() const { return stream_.fd(); }
  const std::string& peer_address() const { return stream_.peer_address(); }

  /// @throws LinkClosed.
  void Send(const Message& message);
  /// The next message that has arrived in full; does not wait.
  /// @throws LinkClosed; LinkError for bytes that are no message of the protocol.
  std::optional<Message> Receive();

 private:
  ByteStream stream_;
  Bytes pending_;  ///< received, not yet a whole message
};

/// Waits for clients at ADDRESS:PORT.
class Listener {
 public:
  /// @throws LinkError, in one line, if the address is not this machine's or the port is taken.
  Listener(const std::string& address, std::uint16_t port);

  int fd() const { return socket_.get(); }
  /// The next client, if there is one; does not wait.
  std::optional<ByteStream> Accept();

 private:
  Descriptor socket_;
};

/// The UDP channel: one datagram a state or command.
class DatagramPort {
 public:
  /// At a free port of `address`. @throws LinkError.
  explicit DatagramPort(const std::string& address);

  int fd() const { return socket_.get(); }
  std::uint16_t port() const;

  void SetPeer(const std::string& address, std::uint16_t port);
  /// To the peer; what cannot be sent is lost, as datagrams are.
  void Send(const Bytes& bytes);
  /// The next datagram of `size` bytes, if there is one; does not wait, drops others. Its sender
  /// becomes the peer if there is none yet; of others nothing is taken.
  std::optional<Bytes> Receive(std::size_t size);

 private:
  Descriptor socket_;
  std::uint32_t peer_address_ = 0;  ///< in the network's order; 0: none
  std::uint16_t peer_port_ = 0;
};

}  // namespace sidestep::robot::fci
