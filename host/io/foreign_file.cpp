// Formats that are not read, each with the line of Python that makes an .npy of it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "io/file_kind.h"
#include "io/frame_source.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// A format by its first bytes or the ending of its name, the code that python_line() completes,
/// and another mend before it.
struct Foreign {
  std::string_view bytes;
  const char* name;
  const char* code;
  const char* ending = "none";
  const char* mend = "";
};

// The largest value of a dictionary, or all that is no dictionary.
constexpr const char* kJson =
    "import json; d = json.load(open({0})); "
    "np.save({1}, max(d.values(), key=np.size) if isinstance(d, dict) else d)";
constexpr const char* kPictures =
    "import glob; from PIL import Image; "
    "np.save({1}, [np.array(Image.open(f)) for f in sorted(glob.glob({3}))])";
constexpr const char* kPages =
    "from PIL import Image, ImageSequence as s; "
    "np.save({1}, [np.array(p) for p in s.Iterator(Image.open({0}))])";
constexpr const char* kWorkbook =
    "import pandas as pd; pd.read_excel({0}).to_csv({6}, index=False)";

// The longest cell of each line, without its names.
constexpr const char* kQuotedFrames =
    "import csv; csv.field_size_limit(2**30); r = list(csv.reader(open({0})))[1:]; "
    "np.save({1}, np.array([max(l, key=len).strip('[]() ').replace(',', ' ').split() for l in r], "
    "float))";

constexpr std::array kForeign = {
    // All arrays of numbers, also those in cells and structs, by their names.
    Foreign{"MATLAB 5.0 MAT-file", "a MATLAB file before version 7.3",
            "import scipy.io as s; a = {{}}; n = np.ndarray; g = lambda k, v: [g('%s.%s' % (k, i), "
            "w) for i, w in (v.items() if isinstance(v, dict) else enumerate(v, 1))] if "
            "isinstance(v, (dict, list)) or isinstance(v, n) and v.dtype == object else "
            "isinstance(v, n) and v.dtype.kind in 'buif' and a.update({{k: v.copy()}}); [g(k, v) "
            "for k, v "
            "in s.loadmat({0}, simplify_cells=True).items()]; np.savez({7}, **a)",
            ".mat", "save it in MATLAB with save({0}, '-v7.3'), or "},
    // All images of readings and arrays of numbers, by their topics.
    Foreign{"\x89MCAP0\r\n", "an MCAP file",
            "from mcap_ros2.reader import read_ros2_messages as r; d = {{}}; "
            "e = dict(mono8='u1', mono16='u2'); e['32FC1'] = 'f4'; "
            "[d.setdefault(getattr(m, 'channel', m).topic.strip('/').replace('/', '.'), []).append("
            "x.data if hasattr(x, 'layout') else "
            "np.frombuffer(bytes(x.data), e[x.encoding]).reshape(x.height, -1)) "
            "for m in r({0}) for x in [m.ros_msg] "
            "if hasattr(x, 'layout') or getattr(x, 'encoding', '') in e]; np.savez({7}, **d)",
            ".mcap",
            "record readings with stream --record FILE.h5, or pip install mcap-ros2-support and "},
    Foreign{"\x80", "a pickle of Python",
            "import pickle; d = pickle.load(open({0}, 'rb')); "
            "np.save({1}, max(d.values(), key=np.size) if isinstance(d, dict) else d)"},
    // The data of a message come last, behind their count.
    Foreign{"SQLite format 3", "a database of SQLite, such as a bag of ROS 2",
            "import sqlite3; b = sqlite3.connect({0}).execute; "
            "i, k = b('SELECT id, type FROM topics WHERE type LIKE \\'%MultiArray\\'').fetchone(); "
            "t = np.dtype(k.split('/')[-1][:-10].lower()); s = t.itemsize; "
            "a = lambda d: next(np.frombuffer(d[-n * s:], t) for n in range(len(d) // s, 0, -1) "
            "if d[-n * s - 4:-n * s] == n.to_bytes(4, 'little')); np.save({1}, [a(r[0]) for r in "
            "b('SELECT data FROM messages WHERE topic_id = ? ORDER BY timestamp', (i,))])"},
    Foreign{"#ROSBAG V", "a bag of ROS 1",
            "from pathlib import Path; from rosbags.highlevel import AnyReader; "
            "r = AnyReader([Path({0})]); r.open(); np.save({1}, [r.deserialize(m, c.msgtype).data "
            "for c, t, m in r.messages() if c.msgtype.endswith('MultiArray')])"},
    Foreign{"\x89PNG\r\n\x1a\n", "a picture (PNG)", kPictures},
    Foreign{"\xff\xd8\xff", "a picture (JPEG)", kPictures},
    Foreign{"II*", "a picture (TIFF)", kPages},
    Foreign{std::string_view("MM\0*", 4), "a picture (TIFF)", kPages},
    Foreign{"PAR1", "a table (Parquet)",
            "import pandas as pd; pd.read_parquet({0}).reset_index().to_csv({6}, index=False)"},
    Foreign{"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a workbook (XLS)", kWorkbook},
    Foreign{"\x1f\x8b", "compressed (gzip)",
            "import gzip; open({4}, 'wb').write(gzip.open({0}).read())"},
    Foreign{"{", "JSON", kJson},
    Foreign{"[", "JSON", kJson},
    Foreign{"<", "XML",
            "import xml.etree.ElementTree as et; "
            "t = [e.text.replace(',', ' ').split() for e in et.parse({0}).iter() if e.text]; "
            "np.save({1}, np.array([w for w in t if len(w) > 3], float))"},
};

/// True if a line below the first has a quoted cell of four numbers or more.
bool has_quoted_frames(std::string_view head) {
  const std::size_t quote = head.find('"', std::min(head.find('\n'), head.size()));
  if (quote == std::string_view::npos) return false;
  const std::string_view cell = head.substr(quote + 1, head.find('"', quote + 1) - quote - 1);
  return cell.find_first_not_of("0123456789.,-+eE[]() ") == std::string_view::npos &&
         std::ranges::count_if(cell, [](char letter) { return letter == ',' || letter == ' '; }) >
             2;
}

std::string quoted(const std::string& text) {
  return text.find_first_of("'\"\\$`!") == std::string::npos ? "'" + text + "'" : "'FILE'";
}

[[noreturn]] void refuse_as(const std::filesystem::path& path, const char* name, const char* code,
                            const char* mend = "") {
  throw Error(
      path.string(), fmt::format("is {}, which is not read", name),
      fmt::format(fmt::runtime(mend), quoted(path.filename().string())) + python_line(code, path));
}

}  // namespace

std::string python_line(std::string_view code, const std::filesystem::path& path) {
  const std::filesystem::path named = path.has_filename() ? path : path.parent_path();
  const std::filesystem::path folder = named.has_parent_path() ? named.parent_path() : ".";
  const auto alike = named.has_extension() ? folder / ("*" + named.extension().string()) : named;
  return fmt::format(
      "run python3 -c \"import numpy as np; {}\"",
      fmt::format(fmt::runtime(code), quoted(named.string()),
                  quoted(named.stem().string() + ".npy"), quoted(folder.string()),
                  quoted(alike.string()), quoted((folder / named.stem()).string()),
                  quoted(named.stem().string() + "_part.npy"),
                  quoted(named.stem().string() + ".csv"), quoted(named.stem().string() + ".npz")));
}

void refuse_foreign(const std::filesystem::path& path, std::string_view head) {
  std::error_code ignored;
  for (const char* const name : {".zarray", ".zgroup", "zarr.json"}) {
    if (!std::filesystem::exists(path / name, ignored)) continue;
    refuse_as(path, "a Zarr store",
              "import zarr; z = zarr.open({0}, mode='r'); np.save({1}, z[:] if hasattr(z, 'shape') "
              "else z[next(iter(z.array_keys()))][:])");
  }
  const bool is_matlab_7_3 = head.starts_with("MATLAB 7.3");  // without HDF5 it is damaged
  head.remove_prefix(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
  const std::string ending = head.empty() || is_matlab_7_3 ? "" : extension_of(path);
  for (const Foreign& foreign : kForeign) {
    if (head.starts_with(foreign.bytes) || ending == foreign.ending) {
      refuse_as(path, foreign.name, foreign.code, foreign.mend);
    }
  }
  if (has_quoted_frames(head))
    refuse_as(path, "a table with a frame in one quoted cell", kQuotedFrames);
}

void refuse_foreign_archive(const std::filesystem::path& path, bool is_workbook) {
  if (is_workbook) refuse_as(path, "a workbook (XLSX)", kWorkbook);
  refuse_as(path, "an archive (ZIP) without arrays of NumPy",
            "import shutil; shutil.unpack_archive({0}, {2})");
}

}  // namespace pillarfield
