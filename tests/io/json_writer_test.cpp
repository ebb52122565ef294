// SPDX-License-Identifier: MIT
#include "puppetri/io/json_writer.h"

#include <doctest/doctest.h>

#include <limits>

using puppetri::io::JsonWriter;

TEST_CASE("commas and quotes fall where JSON wants them [unit]") {
    JsonWriter json;
    json.begin_object()
        .member("a", 1)
        .key("b")
        .begin_array()
        .number(0.1)
        .number(2.0)
        .begin_object()
        .end_object();
    json.boolean(true).end_array().member("c", "x\"\\\n\x01").end_object();
    CHECK(json.text() == "{\"a\":1,\"b\":[0.1,2,{},true],\"c\":\"x\\\"\\\\\\n\\u0001\"}");
}

TEST_CASE("numbers read back with the same bits, and what JSON cannot say is null [unit]") {
    JsonWriter json;
    json.begin_array().number(0.1f).number(0.1).number(1e300).number(-0.5);
    json.number(std::numeric_limits<double>::infinity())
        .number(std::numeric_limits<double>::quiet_NaN());
    json.integer(-9'007'199'254'740'993).end_array();
    CHECK(json.text() == "[0.1,0.1,1e+300,-0.5,null,null,-9007199254740993]");
}

TEST_CASE("bytes that are not UTF-8 become the replacement character, the rest stays [hostile]") {
    JsonWriter json;
    json.string(
        "a\xC3\xA3\xFF"
        "b\xE2\x82");
    CHECK(json.text() ==
          "\"a\xC3\xA3\xEF\xBF\xBD"
          "b\xEF\xBF\xBD\xEF\xBF\xBD\"");
}
