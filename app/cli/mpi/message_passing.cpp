// Messages by MPI: a library by itself, which the program loads where mpirun has started it (processes.hpp).
#include "engine/study/message_sharing.hpp"

#include <mpi.h>

namespace {

class MpiPassing final : public flyball::MessagePassing {
 public:
  MpiPassing() {
    int level = 0; // another thread makes blocks meanwhile, and passes no messages
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiPassing() override {
    settle();
    MPI_Finalize();
  }
  int rank() const override { return rank_; }
  int size() const override { return size_; }

  // Goes on while the message is under way; waits for the one before.
  void send(int to, std::string_view bytes) override {
    settle();
    sent_ = bytes;
    MPI_Isend(sent_.data(), static_cast<int>(sent_.size()), MPI_CHAR, to, 0, MPI_COMM_WORLD, &sending_);
  }
  std::optional<Message> receive(bool wait) override {
    MPI_Status status;
    int there = 1;
    if (wait)
      MPI_Probe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &status);
    else
      MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return {};
    int size = 0;
    MPI_Get_count(&status, MPI_CHAR, &size);
    Message message{status.MPI_SOURCE, std::string(static_cast<std::size_t>(size), '\0')};
    MPI_Recv(message.bytes.data(), size, MPI_CHAR, message.from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return message;
  }

 private:
  void settle() { MPI_Wait(&sending_, MPI_STATUS_IGNORE); }

  int rank_ = 0, size_ = 1;
  std::string sent_;
  MPI_Request sending_ = MPI_REQUEST_NULL;
};

} // namespace

extern "C" flyball::MessagePassing* flyball_message_passing() {
  return new MpiPassing;
}
