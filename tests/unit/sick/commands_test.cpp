// What is said to a scanner, as the fact sheet and the recorded session have it.

#include "sick/commands.hpp"

#include <gtest/gtest.h>

#include "unit/sick/words.hpp"

namespace roverd::sick {
namespace {

std::string body_in_a(const Request& request) {
  return text_of(Bytes(request).subspan(1, request.size() - 2));
}
std::vector<std::uint8_t> body_in_b(const Request& request) {
  return {request.begin() + 8, request.end() - 1};
}
std::vector<std::uint8_t> binary(std::string_view words, std::vector<std::uint8_t> fields) {
  auto out = bytes_of(words);
  out.insert(out.end(), fields.begin(), fields.end());
  return out;
}
std::string_view answer(std::string_view body) {
  const auto bytes = bytes_of(body);
  const Telegram t{Dialect::A, bytes};
  return refusal_in(t, *words_of(t));
}

TEST(SickCommands, AreTheTextsOfTheFactSheet) {
  const Dialect a = Dialect::A;
  EXPECT_EQ(body_in_a(login(a)), "sMN SetAccessMode 03 F4724744");
  EXPECT_EQ(body_in_a(read(a, "LMPscancfg")), "sRN LMPscancfg");
  EXPECT_EQ(body_in_a(call(a, "LMCstartmeas")), "sMN LMCstartmeas");
  EXPECT_EQ(body_in_a(set(a, ScanConfig{})), "sMN mLMPsetscancfg +5000 +1 +5000 -450000 +2250000");
  EXPECT_EQ(body_in_a(set(a, OutputRange{})), "sWN LMPoutputRange 1 1388 FFF92230 225510");
  EXPECT_EQ(body_in_a(set(a, DataConfig{})), "sWN LMDscandatacfg 01 00 1 1 0 00 00 0 0 0 0 +1");
  EXPECT_EQ(body_in_a(subscribe(a, true)), "sEN LMDscandata 1");
  EXPECT_EQ(body_in_a(subscribe(a, false)), "sEN LMDscandata 0");
}

TEST(SickCommands, AreTheBytesOfTheRecordedSession) {
  const Dialect b = Dialect::B;
  EXPECT_EQ(body_in_b(login(b)), binary("sMN SetAccessMode ", {0x03, 0xF4, 0x72, 0x47, 0x44}));
  EXPECT_EQ(body_in_b(set(b, OutputRange{1, 5000, -449'997, 2'250'001 + 12})),
            binary("sWN LMPoutputRange ", {0x00, 0x01, 0x00, 0x00, 0x13, 0x88, 0xFF, 0xF9, 0x22,
                                           0x33, 0x00, 0x22, 0x55, 0x1D}));
  DataConfig no_remission{.remission = false, .remission_16_bit = false, .time = true};
  EXPECT_EQ(body_in_b(set(b, no_remission)),
            binary("sWN LMDscandatacfg ", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1}));
  EXPECT_EQ(body_in_b(call(b, "Run")), bytes_of("sMN Run"));
  EXPECT_EQ(body_in_b(subscribe(b, true)), binary("sEN LMDscandata ", {1}));
}

TEST(SickCommands, AreReadAsTheyWereSaid) {
  const ScanConfig scan{2500, 1, 2500, -50'000, 1'850'000};
  const OutputRange range{1, 2500, -10'000, 900'000};
  const DataConfig data{
      .echoes = 0x0300, .remission_16_bit = false, .encoders = 0x0100, .name = true, .every = 7};
  for (const Dialect d : {Dialect::A, Dialect::B}) {
    const auto fields = [d](const Request& request) {
      const std::size_t before = d == Dialect::A ? 1 : 8;
      const Bytes body = Bytes(request).subspan(before, request.size() - before - 1);
      return Fields(d, body, words_of({d, body})->fields_at);
    };
    const Request a = set(d, scan);
    const Request b = set(d, range);
    const Request c = set(d, data);
    Fields of_scan = fields(a);
    Fields of_range = fields(b);
    Fields of_data = fields(c);
    EXPECT_EQ(read_scan_config(of_scan), scan);
    EXPECT_EQ(read_output_range(of_range), range);
    EXPECT_EQ(read_data_config(of_data), data);
    EXPECT_TRUE(of_scan.ends() && of_range.ends() && of_data.ends());
  }
}

TEST(SickCommands, AnswersSayWhetherItWasDone) {
  EXPECT_EQ(answer("sAN SetAccessMode 1"), "");
  EXPECT_EQ(answer("sAN SetAccessMode 0"), "refused");
  EXPECT_EQ(answer("sAN LMCstartmeas 0"), "");
  EXPECT_EQ(answer("sAN LMCstartmeas 1"), "refused");
  EXPECT_EQ(answer("sAN Run 1"), "");
  EXPECT_EQ(answer("sAN Run"), "refused");
  EXPECT_EQ(answer("sAN mLMPsetscancfg 0 1388 1 1388 FFF92230 225510"), "");
  EXPECT_EQ(answer("sAN mLMPsetscancfg 2 1388 1 1388 FFF92230 225510"), "resolution error");
  EXPECT_EQ(answer("sWA LMPoutputRange"), "");
  EXPECT_EQ(answer("sFA 3"), "unknown variable index");
  EXPECT_EQ(answer("sFA A"), "write access denied");
  EXPECT_EQ(answer("sFA 77"), "error");
  EXPECT_EQ(answer("sFA"), "error");
}

TEST(SickCommands, ErrorsOfBothDialectsHaveACode) {
  const auto code = [](std::vector<std::uint8_t> rest) {
    const auto body = binary("sFA", std::move(rest));
    return error_code({Dialect::B, body});
  };
  EXPECT_EQ(code({0x00, 0x03}), 3);
  EXPECT_EQ(code({' ', 0x00, 0x0D}), 13);
  EXPECT_EQ(code({0x0F}), 15);
  EXPECT_EQ(code({}), 0);
  EXPECT_EQ(error_words(15), "unknown event");
}

TEST(SickCommands, TheStateIsTheFirstNumberOnly) {
  const auto state = [](Dialect d, const std::vector<std::uint8_t>& body) {
    const Telegram t{d, body};
    return state_in(t, *words_of(t));
  };
  const auto told = state(Dialect::A, bytes_of("sRA STlms 7 0 8 16:07:42 10 21.05.2026 0 0 0"));
  ASSERT_TRUE(told);
  EXPECT_EQ(*told, kMeasuring);
  EXPECT_EQ(*state(Dialect::B, binary("sRA STlms ", {0, 4, 0, 0})), 4);
  EXPECT_EQ(*state(Dialect::B, binary("sRA STlms ", {7, 0, 0})), 7);
  EXPECT_FALSE(state(Dialect::A, bytes_of("sRA STlms 8")));
  EXPECT_FALSE(state(Dialect::A, bytes_of("sRA STlms")));
  EXPECT_EQ(state_words(5), "in preparation");
}

TEST(SickCommands, NamesAreTheirLetters) {
  const auto body =
      binary("sRA FirmwareVersion ", {0, 9, 'V', '1', '.', '8', '0', '.', '2', ' ', ' '});
  const Telegram t{Dialect::B, body};
  EXPECT_EQ(letters_in(t, *words_of(t)), "V1.80.2");
}

TEST(SickCommands, WhatHasNoWordsIsNoTelegram) {
  for (const char* body : {"", "s", "xRA STlms", "sRA", "sRA ", "sRA  7"}) {
    const auto bytes = bytes_of(body);
    EXPECT_FALSE(words_of({Dialect::A, bytes})) << body;
  }
}

}  // namespace
}  // namespace roverd::sick
