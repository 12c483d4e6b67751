#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "sample_result.hpp"
#include "store/attribute.hpp"
#include "store/column.hpp"
#include "store/hdf5.hpp"
#include "store/result_file.hpp"
#include "store/seal.hpp"
#include "store/whole_file.hpp"
#include "study/watched.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

using namespace testing_store;
using ::testing::AllOf;
using ::testing::HasSubstr;

class DamagedFile : public testing::Test {
 protected:
  DamagedFile() {
    StudyResult result = made_up_result(study_);
    result.trajectories.push_back({3, made_up_trajectory()});
    write_result(path_, study_, result);
    bytes_ = bytes_of(path_);
  }

  /// What read_result says of the file, "" where it reads it.
  [[nodiscard]] std::string complaint() const {
    try {
      read_result(path_);
      return "";
    } catch (const RunFailure& failure) {
      return failure.what();
    }
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "result.h5";
  Study study_ = sample_study(40);
  std::string bytes_;
};

TEST_F(DamagedFile, IsRefusedWhicheverBitFlips) {
  std::mt19937_64 generator(7);
  for (int flip = 0; flip < 2000; ++flip) {
    std::string damaged = bytes_;
    const std::size_t position = generator() % damaged.size();
    damaged[position] = static_cast<char>(damaged[position] ^ (1 << (generator() % 8)));
    set_bytes(path_, damaged);
    EXPECT_THAT(complaint(), HasSubstr(path_.string())) << "byte " << position;
  }
}

TEST_F(DamagedFile, IsRefusedWhereverItIsCutShort) {
  for (std::size_t size = 0; size < bytes_.size(); size += 1 + bytes_.size() / 300) {
    set_bytes(path_, bytes_.substr(0, size));
    EXPECT_NE(complaint(), "") << "cut to " << size << " bytes";
  }
  set_bytes(path_, bytes_.substr(0, bytes_.size() - 1));
  EXPECT_THAT(complaint(), HasSubstr("cut short"));
  set_bytes(path_, bytes_ + '\n');
  EXPECT_THAT(complaint(), HasSubstr("changed since it was written"));
}

TEST_F(DamagedFile, IsReadAgainOnceItsBytesAreWhatTheyWere) {
  set_bytes(path_, bytes_);
  EXPECT_EQ(complaint(), "");
}

TEST_F(DamagedFile, OfAnotherKindIsToldApartFromADamagedOne) {
  for (const std::string& other : {std::string(), std::string("{}"), std::string(5000, 'x')}) {
    set_bytes(path_, other);
    EXPECT_THAT(complaint(), HasSubstr("not a result file"));
  }
}

TEST_F(DamagedFile, ThatIsMissingOrADirectoryIsSaidToBe) {
  std::filesystem::remove(path_);
  EXPECT_THAT(complaint(), HasSubstr("No such file or directory"));
  std::filesystem::create_directory(path_);
  EXPECT_THAT(complaint(), HasSubstr("Is a directory"));
}

/// A file whose seal is right and whose content is not: what another program could make. `change` alters the open file.
class ForeignFile : public DamagedFile {
 protected:
  template <class Change>
  void rewrite(const Change& change) {
    const std::filesystem::path plain = directory_.path() / "plain.h5";
    set_bytes(plain, bytes_);
    {
      const hdf5::Session session;
      const hdf5::Handle file(H5Fopen(plain.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "cannot open");
      change(file.id());
    }
    const std::string changed = bytes_of(plain);
    set_bytes(path_, changed + seal_of(std::as_bytes(std::span(changed))));
  }

  static void remove(hid_t file, const char* name) {
    hdf5::checked(H5Ldelete(file, name, H5P_DEFAULT), "cannot remove");
  }

  /// Replaces a dataset of /trials or of another group by one of other values.
  template <class Number>
  static void replace(hid_t file, const char* name, std::vector<Number> values, const char* units = "1",
                      const char* place = "trials") {
    const hdf5::Handle group = hdf5::open_group(file, place);
    remove(group.id(), name);
    hdf5::write_column<Number>(group.id(), name, values, units);
  }

  static void set_attribute(hid_t object, const char* name, const auto& value) {
    hdf5::checked(H5Adelete(object, name), "cannot remove");
    hdf5::write_attribute(object, name, value);
  }

  const std::size_t rows_ = 120;
};

TEST_F(ForeignFile, IsReadWhenNothingOfOursChanged) {
  rewrite([](hid_t file) { hdf5::write_attribute(file, "comment", std::string("kept by hand")); });
  EXPECT_EQ(complaint(), "");
}

TEST_F(ForeignFile, MustSayThatItIsAStudy) {
  rewrite([](hid_t file) { set_attribute(file, "filetype", std::string("statepoint")); });
  EXPECT_THAT(complaint(), HasSubstr("filetype is 'statepoint' (it must be 'steerstat-study')"));
  rewrite([](hid_t file) { H5Adelete(file, "filetype"); });
  EXPECT_THAT(complaint(), HasSubstr("no attribute filetype"));
  rewrite([](hid_t file) { set_attribute(file, "filetype", 1.0); });
  EXPECT_THAT(complaint(), HasSubstr("attribute filetype has the wrong type"));
}

TEST_F(ForeignFile, OfANewerFormatNamesTheVersionThatWroteIt) {
  rewrite([](hid_t file) {
    set_attribute(file, "format_version", std::uint32_t{2});
    set_attribute(file, "engine_version", std::string("7.8.9"));
  });
  EXPECT_THAT(complaint(), AllOf(HasSubstr("format 2"), HasSubstr("7.8.9")));
}

TEST_F(ForeignFile, MustHaveTheSpecThatItsDigestIsOf) {
  rewrite([](hid_t file) { set_attribute(file, "spec_sha256", std::string(64, '0')); });
  EXPECT_THAT(complaint(), HasSubstr("spec_sha256"));
  rewrite([](hid_t file) { set_attribute(file, "spec", std::string("{\"plant\": {\"m1\": -1}}")); });
  EXPECT_THAT(complaint(), HasSubstr("/plant/m1"));
}

TEST_F(ForeignFile, MustHaveEveryColumnInFullLength) {
  for (const char* name : {"index", "cell", "status", "settling_time", "end_time", "cycles", "q2_dot"}) {
    rewrite([&](hid_t file) { remove(file, (std::string("trials/") + name).c_str()); });
    EXPECT_THAT(complaint(), HasSubstr(name));
  }
  rewrite([](hid_t file) { remove(file, "parameters/plant.m1"); });
  EXPECT_THAT(complaint(), HasSubstr("plant.m1"));
  rewrite([&](hid_t file) { replace(file, "q1", std::vector<double>(rows_ - 1), "m"); });
  EXPECT_THAT(complaint(), HasSubstr("q1 has 119 rows"));
  rewrite([&](hid_t file) { replace(file, "swings", std::vector<std::uint32_t>(rows_ + 1)); });
  EXPECT_THAT(complaint(), HasSubstr("swings has 121 rows"));
}

TEST_F(ForeignFile, FromBeforeThereWereMetricsHasNone) {
  EXPECT_TRUE(read_result(path_).has_metrics);
  rewrite([](hid_t file) {
    for (const char* name : {"effort", "peak_acceleration", "peak_force", "peak_stroke", "position_contraction_mean",
                             "position_contraction_worst", "velocity_contraction_mean", "velocity_contraction_worst"}) {
      remove(file, (std::string("trials/") + name).c_str());
    }
  });
  const StoredStudy stored = read_result(path_);
  EXPECT_FALSE(stored.has_metrics);
  for (const TrialOutcome& outcome : stored.result.trials.outcomes) {
    for (const Metric& metric : metrics()) {
      const bool older = metric.name == "settling_time" || metric.name == "cycles";
      EXPECT_TRUE(older || std::isnan(metric.value(outcome))) << metric.name;
    }
  }
  rewrite([&](hid_t file) { replace(file, "effort", std::vector<double>(rows_ - 1), "N^2 s"); });
  EXPECT_THAT(complaint(), HasSubstr("effort has 119 rows"));
}

TEST_F(ForeignFile, MustHaveColumnsOfTheRightTypeAndUnits) {
  rewrite([&](hid_t file) { replace(file, "q1", std::vector<std::uint32_t>(rows_), "m"); });
  EXPECT_THAT(complaint(), HasSubstr("q1 has the wrong type"));
  rewrite([&](hid_t file) { replace(file, "q1", std::vector<double>(rows_), "mm"); });
  EXPECT_THAT(complaint(), HasSubstr("units 'mm' (it must be 'm')"));
  rewrite([&](hid_t file) { replace(file, "status", std::vector<std::uint32_t>(rows_)); });
  EXPECT_THAT(complaint(), HasSubstr("status has the wrong type"));
}

TEST_F(ForeignFile, MustHaveStatusesThatAreOutcomes) {
  rewrite([&](hid_t file) {
    const hdf5::Handle group = hdf5::open_group(file, "trials");
    remove(group.id(), "status");
    const hdf5::Handle type = hdf5::enumeration(status_names);
    std::vector<std::uint8_t> values(rows_, 0);
    values[17] = 5;
    hdf5::write_column(group.id(), "status", {type.id(), type.id()}, values.data(), rows_, "1");
  });
  EXPECT_THAT(complaint(), HasSubstr("status 5 in row 17 is no outcome"));
}

TEST_F(ForeignFile, MustHaveAnIndexThatRisesInsideTheStudy) {
  std::vector<std::uint64_t> index(rows_);
  for (std::size_t i = 0; i < rows_; ++i) index[i] = i;
  index[5] = 4;
  rewrite([&](hid_t file) { replace(file, "index", index); });
  EXPECT_THAT(complaint(), HasSubstr("index does not rise"));
  index[5] = 5;
  index.back() = rows_;
  rewrite([&](hid_t file) { replace(file, "index", index); });
  EXPECT_THAT(complaint(), HasSubstr("beyond the last of 120 trials"));
  rewrite([&](hid_t file) { replace(file, "index", std::vector<std::uint64_t>(rows_ + 1)); });
  EXPECT_THAT(complaint(), HasSubstr("121 rows for 120 trials"));
}

TEST_F(ForeignFile, MustHaveColumnsThatAgreeWithEachOther) {
  rewrite([&](hid_t file) { replace(file, "cell", std::vector<std::uint64_t>(rows_, 1)); });
  EXPECT_THAT(complaint(), HasSubstr("cell 1 in row 0"));
  rewrite([&](hid_t file) { replace(file, "settling_time", std::vector<double>(rows_, 3.0), "s"); });
  EXPECT_THAT(complaint(), HasSubstr("settling_time in row 0"));
}

TEST_F(ForeignFile, MustHaveAnAuditOfItsOwnTrials) {
  const auto audit_of = [&](std::vector<std::uint64_t> index) {
    rewrite([&](hid_t file) { replace(file, "index", index, "1", "audit"); });
    return complaint();
  };
  EXPECT_EQ(audit_of({0, 3, 10}), "");
  EXPECT_THAT(audit_of({0, 3, 3}), HasSubstr("/audit/index does not rise"));
  EXPECT_THAT(audit_of({0, 3, 120}), HasSubstr("/audit/index 120 is not the index of a trial in the file"));
  EXPECT_THAT(audit_of({0, 3}), HasSubstr("/audit/index 2"));
  EXPECT_THAT(audit_of(std::vector<std::uint64_t>(rows_ + 1)), HasSubstr("/audit has 121 of 120 trials"));
}

TEST_F(ForeignFile, MustHaveAnAuditThatAgreesWithItself) {
  const StudyResult result = made_up_result(study_);
  std::vector<double> times;
  for (const AuditedTrial& trial : result.audit.trials) {
    times.push_back(trial.status == Status::converged ? trial.settling_time : 1.0);
  }
  ASSERT_NE(std::count_if(times.begin(), times.end(), [](double t) { return t == 1.0; }), 0);
  rewrite([&](hid_t file) { replace(file, "settling_time", times, "s", "audit"); });
  EXPECT_THAT(complaint(), HasSubstr("/audit/settling_time in row"));
  rewrite([](hid_t file) { remove(file, "audit"); });
  EXPECT_THAT(complaint(), HasSubstr("audit"));
}

TEST_F(ForeignFile, MustNameAnInstructionSetThatExists) {
  rewrite([](hid_t file) { set_attribute(file, "simd", std::string("mmx")); });
  EXPECT_THAT(complaint(), HasSubstr("simd 'mmx' is no instruction set"));
}

TEST_F(ForeignFile, MustHaveAllTrialsWhenItIsCalledComplete) {
  StudyResult result = made_up_result(study_);
  result.trials.index.pop_back();
  result.trials.outcomes.pop_back();
  write_result(path_, study_, result);
  EXPECT_THAT(complaint(), HasSubstr("complete with 119 of 120 trials"));
}

TEST_F(ForeignFile, OfAStudyThatStopsIsCompleteWithTheTrialsUpToItsLastLook) {
  Study study = study_;
  study.stop = StopRule{5, 5, 0.95, {{"success_rate", std::nullopt, 0.3, false}}};
  study.intervals = default_intervals(true);
  StudyResult result = made_up_result(study);
  const std::uint64_t due = trials_due(study, result.trials);
  ASSERT_LT(due, 120U);
  for (const std::uint64_t rows : {due + 1, due, due - 1}) {
    result.trials.index.resize(rows);
    result.trials.outcomes.resize(rows);
    write_result(path_, study, result);
    if (rows == due) {
      EXPECT_TRUE(read_result(path_).result.complete);
    } else {
      // Fewer do not reach the look, so that all would be due.
      EXPECT_THAT(complaint(),
                  HasSubstr("complete with " + std::to_string(rows) + " of " + std::to_string(rows > due ? due : 120)));
    }
  }
}

TEST_F(ForeignFile, WithAColumnThatItsChecksumContradictsIsRefusedInTheWordsOfHdf5) {
  // Flip a bit of a stored value, then seal the file anew: only the chunk's own checksum can tell.
  const std::string content = bytes_.substr(0, bytes_.size() - seal_of({}).size());
  const double value = made_up_result(study_).trials.outcomes[60].passive_error;
  const std::string pattern(reinterpret_cast<const char*>(&value), sizeof value);
  const std::size_t place = content.find(pattern);
  ASSERT_NE(place, std::string::npos);
  std::string changed = content;
  changed[place] = static_cast<char>(changed[place] ^ 1);
  set_bytes(path_, changed + seal_of(std::as_bytes(std::span(changed))));
  EXPECT_THAT(complaint(), AllOf(HasSubstr("passive_error"), HasSubstr("Fletcher32")));
}

}  // namespace
}  // namespace steerstat
