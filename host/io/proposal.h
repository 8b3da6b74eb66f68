#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/file_source.h"
#include "pillarfield/error.h"
#include "pillarfield/read_options.h"

namespace pillarfield {

/// A way on that an error may propose.
struct Proposal {
  std::string words;         ///< for the command line, "--columns 'p*'"; texts in quotes
  ReadOptions options = {};  ///< with which the file is then read
  std::size_t readings = 0;  ///< in a line, if the size of a frame is open; 0: it is not
};

/// An error with proposals, of which settled() takes the first that works, after the words `lead`.
/// Without one, `question` is the mend.
class ProposingError : public Error {
 public:
  ProposingError(const std::string& place, const std::string& failure, const std::string& question,
                 std::string lead, std::vector<Proposal> proposals)
      : Error(place, failure, question), lead_(std::move(lead)), proposals_(std::move(proposals)) {}

  [[nodiscard]] const std::string& lead() const { return lead_; }
  [[nodiscard]] const std::vector<Proposal>& proposals() const { return proposals_; }

 private:
  std::string lead_;
  std::vector<Proposal> proposals_;
};

/// Opens the file with these options.
using Opener = std::function<std::unique_ptr<FileSource>(const ReadOptions&)>;

/// The error that users get: the reader runs with each proposal, and the first that it takes is
/// the mend, with placeholders for size and rate if these stay open.
[[nodiscard]] Error settled(const ProposingError& error, const Opener& open);

}  // namespace pillarfield
