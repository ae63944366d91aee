// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/command.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "drivers/clients/commands/command_packet.hpp"
#include "drivers/clients/messages/record.hpp"

namespace cairn::clients {
namespace {

using namespace std::chrono_literals;

Command sample(Command::Verb verb) {
  Command command{verb, 12, Time{5s}, 150ms, 0.4, -0.2, 3, ClientName("a desk with a name of 32 letters"), {}};
  if (verb == Command::Verb::kPlace)
    command.place = {ShortText<32>("a robot of a name of 32 letters."), 12.5, -3, 1.5, 0.4, 0.2};
  return command;
}

TEST(Command, ComesBackAsItWasSent) {
  std::vector<std::byte> bytes;
  for (int verb = 1; verb <= 7; ++verb) {
    const Command command = sample(static_cast<Command::Verb>(verb));
    encode(command, bytes);
    EXPECT_LE(bytes.size(), kMaxCommandBytes);
    const auto decoded = decode_command(bytes);
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    EXPECT_EQ(*decoded, command);
    EXPECT_FALSE(to_string(command.verb).empty());
  }
}

TEST(Command, CutOrOfAnUnknownVerbIsRefused) {
  std::vector<std::byte> bytes;
  encode(sample(static_cast<Command::Verb>(8)), bytes);
  EXPECT_EQ(decode_command(bytes).error().code, Errc::kMalformed);
  encode(sample(Command::Verb::kStop), bytes);
  for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_FALSE(decode_command(std::span(bytes).first(size)));
  encode(Answer{}, 1, bytes);
  EXPECT_FALSE(decode_command(bytes)) << "an answer";
}

TEST(Command, ABodyCutAnywhereIsRefusedEvenWithARightChecksum) {
  std::vector<std::byte> whole;
  for (const auto verb : {Command::Verb::kArm, Command::Verb::kPlace}) {
    encode(sample(verb), whole);
    for (std::size_t size = Record::kHeaderBytes; size < whole.size(); ++size) {
      std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      end_record(cut);
      EXPECT_EQ(decode_command(cut).error().code, Errc::kMalformed) << size;
    }
  }
  encode(Answer{.number = 3, .holder = ClientName("desk"), .why = ShortText<200>("late")}, 1, whole);
  for (std::size_t size = Record::kHeaderBytes; size < whole.size(); ++size) {
    std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    end_record(cut);
    EXPECT_FALSE(decode_answer(cut)) << size;
  }
}

TEST(Command, ANameThatCouldSteerATerminalIsRefused) {
  Command command = sample(Command::Verb::kHold);
  command.who = ClientName("\x1B[2J");
  std::vector<std::byte> bytes;
  encode(command, bytes);
  EXPECT_FALSE(decode_command(bytes));
}

TEST(Placement, WhatCannotBeIsKnown) {
  const Placement sound{ShortText<32>(), 1, 2, 3, 0.5, 0.1};
  EXPECT_TRUE(sound.possible());
  EXPECT_TRUE(Placement{}.possible()) << "it takes back what was said";
  for (const double wrong : {std::nan(""), 1e6, -1e6}) {
    for (double Placement::*field :
         {&Placement::x, &Placement::y, &Placement::yaw, &Placement::sigma_m, &Placement::sigma_rad}) {
      Placement place = sound;
      place.*field = wrong;
      EXPECT_FALSE(place.possible()) << wrong;
    }
  }
}

TEST(Answer, ComesBackAsItWasSent) {
  const Answer answer{Answer::Outcome::kRefused,    7, 4, true, 0.1, 0.2, ClientName("desk"),
                      ShortText<200>("e_stop_open")};
  std::vector<std::byte> bytes;
  encode(answer, 9, bytes);
  EXPECT_EQ(decode_answer(bytes).value(), answer);
  for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_FALSE(decode_answer(std::span(bytes).first(size)));
}

TEST(Answer, AGreetingIsTheOneThatNobodyAskedFor) {
  std::vector<std::byte> bytes;
  encode(Answer{.epoch = 4, .holder = {}, .why = {}}, 1, bytes);
  const auto greeting = decode_answer(bytes);
  ASSERT_TRUE(greeting);
  EXPECT_EQ(greeting->number, 0U);
  EXPECT_EQ(greeting->epoch, 4U);
}

TEST(ShortText, CutsWhatIsTooLong) {
  ShortText<5> text("abc");
  text.append("defg");
  EXPECT_EQ(text.view(), "abcde");
}

}  // namespace
}  // namespace cairn::clients
