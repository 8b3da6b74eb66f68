// Formats that are not read, each with the line of Python that makes an .npy of it.

#include "io/foreign_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <system_error>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// A format by its first bytes, from `offset` on.
struct Foreign {
  const char* name;
  std::size_t offset;
  std::string_view bytes;
  const char* code;  ///< of Python, see python_line()
};

/// The largest value of a dictionary, or all that is no dictionary.
constexpr const char* kPickle =
    "import pickle, numpy as np; d = pickle.load(open({0}, 'rb')); "
    "np.save({1}, max(d.values(), key=np.size) if isinstance(d, dict) else d)";
constexpr const char* kJson =
    "import json, numpy as np; d = json.load(open({0})); "
    "np.save({1}, max(d.values(), key=np.size) if isinstance(d, dict) else d)";
constexpr const char* kXml =
    "import xml.etree.ElementTree as et, numpy as np; "
    "t = [e.text.replace(',', ' ').split() for e in et.parse({0}).iter() if e.text]; "
    "np.save({1}, np.array([w for w in t if len(w) > 3], float))";
/// The data of a message come last, behind their count.
constexpr const char* kSqlite =
    "import sqlite3, numpy as np; b = sqlite3.connect({0}); "
    "i, k = b.execute('SELECT id, type FROM topics WHERE type LIKE \\'%MultiArray\\'').fetchone(); "
    "t = np.dtype(k.split('/')[-1][:-10].lower()); s = t.itemsize; "
    "a = lambda d: next(np.frombuffer(d[-n * s:], t) for n in range(len(d) // s, 0, -1) "
    "if d[-n * s - 4:-n * s] == n.to_bytes(4, 'little')); "
    "np.save({1}, [a(r[0]) for r in b.execute("
    "'SELECT data FROM messages WHERE topic_id = ? ORDER BY timestamp', (i,))])";
constexpr const char* kPictures =
    "import glob, numpy as np; from PIL import Image; "
    "np.save({1}, [np.array(Image.open(f)) for f in sorted(glob.glob({3}))])";
constexpr const char* kPages =
    "import numpy as np; from PIL import Image, ImageSequence; "
    "np.save({1}, [np.array(p) for p in ImageSequence.Iterator(Image.open({0}))])";
constexpr const char* kVideo =
    "import numpy as np, imageio.v3 as iio; "
    "np.save({1}, [f[..., 0] for f in iio.imiter({0})])";
constexpr const char* kParquet =
    "import numpy as np, pandas as pd; "
    "np.save({1}, pd.read_parquet({0}).select_dtypes('number').to_numpy())";
constexpr const char* kFeather =
    "import numpy as np, pandas as pd; "
    "np.save({1}, pd.read_feather({0}).select_dtypes('number').to_numpy())";
constexpr const char* kWorkbook =
    "import numpy as np, pandas as pd; "
    "np.save({1}, pd.read_excel({0}).select_dtypes('number').to_numpy())";
constexpr const char* kZarr =
    "import numpy as np, zarr; z = zarr.open({0}, mode='r'); "
    "np.save({1}, z[:] if hasattr(z, 'shape') else z[next(iter(z.array_keys()))][:])";
constexpr const char* kBag =
    "import numpy as np; from pathlib import Path; from rosbags.highlevel import AnyReader; "
    "r = AnyReader([Path({0})]); r.open(); np.save({1}, [r.deserialize(m, c.msgtype).data "
    "for c, t, m in r.messages() if c.msgtype.endswith('MultiArray')])";
constexpr const char* kArchive = "import shutil; shutil.unpack_archive({0}, {2})";
constexpr const char* kGzip = "import gzip; open({4}, 'wb').write(gzip.open({0}).read())";
constexpr const char* kBzip2 = "import bz2; open({4}, 'wb').write(bz2.open({0}).read())";
constexpr const char* kXz = "import lzma; open({4}, 'wb').write(lzma.open({0}).read())";
constexpr const char* kWave =
    "import numpy as np, scipy.io.wavfile as w; np.save({1}, w.read({0})[1])";

constexpr std::array kForeign = {
    Foreign{"a pickle of Python", 0, "\x80\x02", kPickle},
    Foreign{"a pickle of Python", 0, "\x80\x03", kPickle},
    Foreign{"a pickle of Python", 0, "\x80\x04", kPickle},
    Foreign{"a pickle of Python", 0, "\x80\x05", kPickle},
    Foreign{"a database of SQLite, such as a bag of ROS 2", 0, "SQLite format 3", kSqlite},
    Foreign{"a bag of ROS 1", 0, "#ROSBAG V", kBag},
    Foreign{"a picture (PNG)", 0, "\x89PNG\r\n\x1a\n", kPictures},
    Foreign{"a picture (JPEG)", 0, "\xff\xd8\xff", kPictures},
    Foreign{"a picture (BMP)", 0, "BM", kPictures},
    Foreign{"a picture (PGM)", 0, "P5", kPictures},
    Foreign{"a picture (GIF)", 0, "GIF8", kPages},
    Foreign{"a picture (TIFF)", 0, std::string_view("II*\0", 4), kPages},
    Foreign{"a picture (TIFF)", 0, std::string_view("MM\0*", 4), kPages},
    Foreign{"a picture (TIFF)", 0, std::string_view("II+\0", 4), kPages},
    Foreign{"a video (AVI)", 8, "AVI ", kVideo},
    Foreign{"a video (MP4)", 4, "ftyp", kVideo},
    Foreign{"a video (Matroska)", 0, "\x1a\x45\xdf\xa3", kVideo},
    Foreign{"a sound (WAV)", 8, "WAVE", kWave},
    Foreign{"a table (Parquet)", 0, "PAR1", kParquet},
    Foreign{"a table (Arrow, Feather)", 0, "ARROW1", kFeather},
    Foreign{"a workbook (XLS)", 0, "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", kWorkbook},
    Foreign{"compressed (gzip)", 0, "\x1f\x8b", kGzip},
    Foreign{"compressed (bzip2)", 0, "BZh", kBzip2},
    Foreign{"compressed (xz)", 0,
            std::string_view("\xfd"
                             "7zXZ\0",
                             6),
            kXz},
    Foreign{"an archive (tar)", 257, "ustar", kArchive},
};

/// The text without the blanks and the mark of UTF-8 before it.
std::string_view without_beginning(std::string_view head) {
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  return head.substr(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
}

std::string quoted(const std::string& text) {
  return text.find_first_of("'\"\\$`!") == std::string::npos ? "'" + text + "'" : "'FILE'";
}

[[noreturn]] void refuse_as(const std::filesystem::path& path, const char* name, const char* code) {
  throw Error(path.string(), fmt::format("is {}, which is not read", name),
              python_line(code, path));
}

}  // namespace

std::string python_line(std::string_view code, const std::filesystem::path& path) {
  const std::filesystem::path named = path.has_filename() ? path : path.parent_path();
  const std::filesystem::path folder = named.has_parent_path() ? named.parent_path() : ".";
  const std::filesystem::path alike =
      named.has_extension() ? folder / ("*" + named.extension().string()) : named;
  const std::string unpacked = (folder / named.stem()).string();
  return fmt::format("run python3 -c \"{}\"",
                     fmt::format(fmt::runtime(code), quoted(named.string()),
                                 quoted(named.stem().string() + ".npy"), quoted(folder.string()),
                                 quoted(alike.string()), quoted(unpacked)));
}

void refuse_foreign(const std::filesystem::path& path, std::string_view head) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    for (const char* name : {".zarray", ".zgroup", "zarr.json"}) {
      if (std::filesystem::exists(path / name, ignored)) refuse_as(path, "a Zarr store", kZarr);
    }
    return;
  }
  for (const Foreign& foreign : kForeign) {
    if (head.size() < foreign.offset + foreign.bytes.size()) continue;
    if (head.substr(foreign.offset, foreign.bytes.size()) == foreign.bytes) {
      refuse_as(path, foreign.name, foreign.code);
    }
  }
  const std::string_view text = without_beginning(head);
  if (text.starts_with('{') || text.starts_with('[')) refuse_as(path, "JSON", kJson);
  if (text.starts_with('<')) refuse_as(path, "XML", kXml);
}

void refuse_foreign_archive(const std::filesystem::path& path, bool is_workbook) {
  refuse_as(path, is_workbook ? "a workbook (XLSX)" : "an archive (ZIP) without arrays of NumPy",
            is_workbook ? kWorkbook : kArchive);
}

}  // namespace pillarfield
