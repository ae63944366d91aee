// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/sd_notify.hpp"

#include <gtest/gtest.h>

#include "tests/support/local_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

TEST(SdNotify, SendsDatagramsToAPathAndToAnAbstractName) {
  const support::TemporaryFolder folder;
  for (const std::string& name : {(folder / "notify").string(), "@cairn-test-" + std::to_string(::getpid())}) {
    support::DatagramListener manager(name);
    auto notify = SdNotify::open(name).value();
    ASSERT_TRUE(notify.notify("READY=1")) << name;
    ASSERT_TRUE(notify.notify("WATCHDOG=1\nSTATUS=normal"));
    EXPECT_EQ(manager.next(), "READY=1");
    EXPECT_EQ(manager.next(), "WATCHDOG=1\nSTATUS=normal");
    EXPECT_EQ(manager.next(), "");
  }
}

TEST(SdNotify, WithoutAManagerItSaysNothing) {
  auto notify = SdNotify::open("").value();
  EXPECT_TRUE(notify.notify("READY=1"));
}

TEST(SdNotify, NeverBlocks) {
  const support::TemporaryFolder folder;
  const support::DatagramListener deaf((folder / "notify").string());
  auto notify = SdNotify::open((folder / "notify").string()).value();
  bool refused = false;
  for (int i = 0; i < 100'000 && !refused; ++i) refused = !notify.notify("WATCHDOG=1");
  EXPECT_TRUE(refused);
}

TEST(SdNotify, AddressesThatAreNoneAreRefused) {
  for (const std::string& name :
       {std::string("relative"), std::string("/"), std::string("@"), "/" + std::string(107, 'x')})
    EXPECT_FALSE(SdNotify::open(name)) << name;
  const support::TemporaryFolder folder;
  EXPECT_FALSE(SdNotify::open((folder / "nobody").string()).value().notify("READY=1"));
}

TEST(SdNotify, TheTimeOutIsForTheNamedProcessAlone) {
  EXPECT_EQ(watchdog_timeout("1000000", "", 5), 1s);
  EXPECT_EQ(watchdog_timeout("1000000", "5", 5), 1s);
  EXPECT_FALSE(watchdog_timeout("1000000", "6", 5));
  for (const char* bad : {"", "0", "-1", "1e6", "10 ", "99999999999999999999"})
    EXPECT_FALSE(watchdog_timeout(bad, "", 5)) << bad;
}

}  // namespace
}  // namespace cairn::app
