#include "io/hdf5/links.h"

#include <fmt/format.h>

#include <string>

#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

herr_t refuse_external_link(const char*, const char*, const char*, const char*, unsigned*, hid_t,
                            void*) {
  return -1;
}

/// An access list that forbids links to other files: such a file could be a FIFO, whose open never
/// returns, or one that the reader may see and the sender may not.
Handle access_within_file(const File& file) {
  constexpr const char* kFailure = "HDF5 does not accept a rule for links";
  Handle access = own(H5Pcreate(H5P_LINK_ACCESS), file.path, kFailure);
  require(H5Pset_elink_cb(access.get(), refuse_external_link, nullptr), file.path, kFailure);
  return access;
}

/// Whether the link `path`, whose parents are valid, leads to an object of this file.
bool leads_within_file(const File& file, const std::string& path, const Handle& access) {
  H5L_info_t link = {};
  require(H5Lget_info(file.id.get(), path.c_str(), &link, access.get()), file.path,
          fmt::format("{} cannot be looked up", path), kDamaged);
  if (link.type == H5L_TYPE_HARD) return true;
  return link.type == H5L_TYPE_SOFT &&
         H5Oexists_by_name(file.id.get(), path.c_str(), access.get()) > 0;
}

}  // namespace

bool exists(const File& file, std::string_view path) {
  const Handle access = access_within_file(file);
  // HDF5 checks one link at a time.
  for (std::size_t end = 1; end != std::string_view::npos;) {
    end = path.find('/', end + 1);
    const std::string parent(path.substr(0, end));
    const htri_t found = H5Lexists(file.id.get(), parent.c_str(), access.get());
    require(found, file.path, fmt::format("{} cannot be looked up", parent), kDamaged);
    if (found == 0) return false;
    if (leads_within_file(file, parent, access)) continue;
    throw Error(file.path.string(),
                fmt::format("{} is a link that leads to another file or nowhere", parent),
                "copy its target into this file");
  }
  return true;
}

Handle open_object(const File& file, const char* path) {
  if (!exists(file, path)) {
    throw Error(file.path.string(), fmt::format("has no {}", path),
                "docs/formats.md lists the required objects");
  }
  const Handle access = access_within_file(file);
  return own(H5Oopen(file.id.get(), path, access.get()), file.path,
             fmt::format("{} cannot be opened", path), kDamaged);
}

}  // namespace pillarfield::hdf5
