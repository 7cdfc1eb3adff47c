// Work shared by processes that pass messages: the first one hands blocks out to whoever is free, makes some
// itself on a thread beside, and takes all of them in order. Each process makes one block at a time and has
// the next ones at hand, so that nobody waits for the first one's answer.
#pragma once

#include "engine/study/work_sharing.hpp"

#include <optional>

namespace flyball {

// The processes started together, numbered from zero; messages from one to another arrive in order.
class MessagePassing {
 public:
  struct Message {
    int from = 0;
    std::string bytes;
  };
  virtual ~MessagePassing() = default;
  virtual int rank() const = 0; // this one's number
  virtual int size() const = 0; // how many there are
  virtual void send(int to, std::string_view bytes) = 0;
  // The next message to this process; nothing where there is none yet and it does not wait.
  virtual std::optional<Message> receive(bool wait) = 0;
};

class MessageSharing final : public WorkSharing {
 public:
  // `passing` must outlive it. All processes have to run() the same work; one that ends before ends it for
  // all.
  explicit MessageSharing(MessagePassing& passing) : passing_(passing) {}
  ~MessageSharing() override;
  MessageSharing(const MessageSharing&) = delete;
  MessageSharing& operator=(const MessageSharing&) = delete;
  void run(const SharedWork& work) override;
  bool takes() const override { return passing_.rank() == 0; }

 private:
  void serve(const SharedWork& work);
  void make(const SharedWork& work);

  MessagePassing& passing_;
  bool ran_ = false;
};

} // namespace flyball
