// Content-addressed results, and the digests that they are found by.

#include "coast/io/result_store.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "coast/io/file_digests.hpp"
#include "coast/io/sha256.hpp"
#include "coast/io/writers.hpp"
#include "support/support.hpp"

namespace coast::io {
namespace {

namespace fs = std::filesystem;

// NIST, Cryptographic Standards and Guidelines, examples with intermediate values of SHA-256; the long message of FIPS 180-2,
// B.3.
TEST(Sha256, MatchesPublishedDigests) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, IsThatOfTheSystemForEveryLengthAndPiece) {
  const test::TemporaryDirectory folder;
  std::string text;
  for (int i = 0; i < 200; ++i) text += static_cast<char>(i * 7 + 1);
  for (const std::size_t length : {1U, 55U, 56U, 57U, 63U, 64U, 65U, 119U, 120U, 128U, 200U}) {
    const fs::path file = folder.path() / "bytes";
    write_text(file, text.substr(0, length));
    ASSERT_EQ(std::system(("sha256sum '" + file.string() + "' >'" + (folder.path() / "sum").string() + "'").c_str()), 0);
    std::ifstream sum(folder.path() / "sum");
    std::string expected;
    sum >> expected;
    EXPECT_EQ(sha256_of_file(file), expected) << length;
    Sha256 pieces;
    for (std::size_t at = 0; at < length; at += 13)
      pieces.add(std::string_view(text).substr(at, std::min<std::size_t>(13, length - at)));
    EXPECT_EQ(pieces.hex(), expected) << length;
  }
}

TEST(FileDigests, AreRememberedOnlyOfWhatHasSettledAndHasNotChanged) {
  const test::TemporaryDirectory folder;
  const fs::path file = folder.path() / "input", memory = folder.path() / "digests";
  write_text(file, "one");
  {
    FileDigests digests(memory);
    EXPECT_EQ(digests.of(file), sha256("one"));
    digests.save();
    EXPECT_FALSE(fs::exists(memory));  // changed a moment ago: the next change may carry the same time
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(3100));
  {
    FileDigests digests(memory);
    EXPECT_EQ(digests.of(file), sha256("one"));
    digests.save();
  }
  // What is remembered is used: a false digest in the memory is believed, as long as the file stays.
  std::ifstream in(memory);
  std::string line;
  std::getline(in, line);
  write_text(memory, std::string(64, '0') + line.substr(64) + "\ndamaged\n");
  EXPECT_EQ(FileDigests(memory).of(file), std::string(64, '0'));
  write_text(file, "two");
  EXPECT_EQ(FileDigests(memory).of(file), sha256("two"));
}

TEST(ResultStore, ResultsAppearWholeAndTheFirstStays) {
  const test::TemporaryDirectory folder;
  const ResultStore store(folder.path());
  const std::string key = sha256("key");
  {
    ResultStore::Work lost(store, key);
    write_text(lost.folder() / "result.json", "lost");
    EXPECT_FALSE(store.has(key, "result.json"));
  }
  ResultStore::Work first(store, key), second(store, key);
  write_text(first.folder() / "result.json", "first");
  write_text(second.folder() / "result.json", "second");
  first.finish("result.json");
  second.finish("result.json");
  EXPECT_EQ(store.read(key, "result.json"), "first");
  EXPECT_EQ(store.folder_of(key).parent_path().filename(), key.substr(0, 2));
  store.remove(key);
  EXPECT_FALSE(store.has(key, "result.json"));
}

TEST(ResultStore, WhatAKilledProcessLeavesIsRemovedAndWhatALivingOneWritesStays) {
  const test::TemporaryDirectory folder;
  const ResultStore store(folder.path());
  const pid_t child = ::fork();
  if (child == 0) {
    const ResultStore::Work work(store, sha256("killed"));
    ::_exit(0);  // without the destructor, as by SIGKILL
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  const ResultStore::Work own(store, sha256("own"));
  const auto unfinished = [&] {
    return std::distance(fs::directory_iterator(folder.path() / "unfinished"), fs::directory_iterator{});
  };
  EXPECT_EQ(unfinished(), 2);
  store.remove_unfinished();
  EXPECT_EQ(unfinished(), 1);
  EXPECT_TRUE(fs::exists(own.folder()));
}

}  // namespace
}  // namespace coast::io
