// What may follow `serial:`.

#include "streams/source/serial_address.h"

#include <gtest/gtest.h>

#include "streams/source/flexitac_parser.h"
#include "streams/source/packet_parser.h"
#include "tests/base/message.h"

namespace pillarfield::streams_test {
namespace {

TEST(SerialAddress, NamesDeviceAndProtocol) {
  const SerialAddress bare = serial_address("/dev/ttyACM0");
  EXPECT_EQ(bare.device, "/dev/ttyACM0");
  EXPECT_NE(dynamic_cast<PacketParser*>(bare.parser.get()), nullptr);
  const SerialAddress board = serial_address("/dev/ttyUSB0?cols=32&protocol=flexitac&rows=16");
  EXPECT_EQ(board.device, "/dev/ttyUSB0");
  EXPECT_NE(dynamic_cast<FlexitacParser*>(board.parser.get()), nullptr);
  EXPECT_NE(dynamic_cast<PacketParser*>(serial_address("x?protocol=packets").parser.get()),
            nullptr);
}

TEST(SerialAddress, SaysWhatIsWrong) {
  const auto expect = [](const std::string& text, const std::string& words) {
    const std::string message = core_test::message_of([&] { (void)serial_address(text); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  expect("x?protocol=flexi",
         "protocol 'flexi' is unknown; did you mean 'flexitac'?; give one of packets, flexitac");
  // As a shell passes it that took '&' for its own.
  expect("x?protocol=flexitac", "needs rows and cols; rows is missing; give, in quotes, 'serial:");
  expect("x?protocol=flexitac&rows=16", "cols is missing");
  for (const char* const rows :
       {"1", "0", "-2", "65535", "16x", "", "1e3", "99999999999999999999"}) {
    expect(std::string("x?protocol=flexitac&cols=32&rows=") + rows,
           std::string("rows is '") + rows + "', not a number from 2 to 65534");
  }
  expect("x?protocol=flexitac&rows=65534&cols=65534", "65534 x 65534 sensels are too many");
  expect("x?protocol=flexitac&rows=16&col=32", "option 'col' is unknown; did you mean 'cols'?");
  expect("x?protocol=flexitac&rows=16&rows=16", "option 'rows' has two values");
  expect("x?rows", "option 'rows' has no value");
  expect("x?rows=16&cols=32", "packets bring rows and columns");
  expect("x?\x1b=1", "option '\\u001b' is unknown");
}

}  // namespace
}  // namespace pillarfield::streams_test
