// SPDX-License-Identifier: Apache-2.0
#include "hal/config/yaml_document.hpp"

#include <gtest/gtest.h>

namespace cairn {
namespace {

TEST(YamlDocument, IsReadAsYamlCppReadsIt) {
  const YAML::Node node = parse_yaml_document("# robot\na: 1\nb: [x, y]\n");
  EXPECT_EQ(node["a"].as<int>(), 1);
  EXPECT_EQ(node["b"].size(), 2U);
}

TEST(YamlDocument, AnEmptyTextIsNull) {
  EXPECT_TRUE(parse_yaml_document("").IsNull());
  EXPECT_TRUE(parse_yaml_document("# nothing\n").IsNull());
}

TEST(YamlDocument, ASecondDocumentIsRefusedWhereItBegins) {
  try {
    (void)parse_yaml_document("a: 1\n---\nb: 2\n");
    FAIL();
  } catch (const YAML::ParserException& e) {
    EXPECT_EQ(e.mark.line, 1);
  }
}

TEST(YamlDocument, OnlyUtf8IsRead) {
  const std::string longest = "\u007f \u0080\u07ff \u0800\ud7ff\ue000\uffff \U00010000\U0010ffff";
  EXPECT_EQ(parse_yaml_document("a: '" + longest + "'")["a"].Scalar(), longest);
  for (const char* text : {"\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80",
                           "\xf5\x80\x80\x80", "\xe2\x82", "\xff", "\xfe\xff"}) {
    try {
      (void)parse_yaml_document("# a robot\nb: " + std::string(text) + "\n");
      FAIL() << text;
    } catch (const YAML::ParserException& e) {
      EXPECT_EQ(e.mark.line, 1);
    }
  }
}

// yaml-cpp 0.7 takes each of these for a series of empty documents without end.
TEST(YamlDocument, TextsThatYamlCppNeverFinishesAreRefused) {
  for (const char* text : {",", "a: {}\n,", "[a],,"})
    EXPECT_THROW((void)parse_yaml_document(text), YAML::ParserException) << text;
}

}  // namespace
}  // namespace cairn
