/// @file Hdf5File.cc
/// A driver of the HDF5 library (a "virtual file driver"), and the calls.
#include "io/Hdf5File.h"

#include <vdbtet/Errors.h>

#include <hdf5.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>

namespace vdbtet {

void Hdf5Image::write(std::uint64_t offset, const void* data, std::size_t size) {
    const char* from = static_cast<const char*>(data);
    while (size > 0) {
        const std::uint64_t inPage = offset % kPageBytes;
        const std::size_t some = std::min<std::size_t>(size, kPageBytes - inPage);
        std::memcpy(mPages[offset / kPageBytes].data() + inPage, from, some);
        offset += some;
        from += some;
        size -= some;
    }
}

void Hdf5Image::read(std::uint64_t offset, void* data, std::size_t size) {
    char* to = static_cast<char*>(data);
    while (size > 0) {
        const std::uint64_t inPage = offset % kPageBytes;
        const std::size_t some = std::min<std::size_t>(size, kPageBytes - inPage);
        const auto page = mPages.find(offset / kPageBytes);
        if (page == mPages.end()) {
            std::memset(to, 0, some);
        } else {
            std::memcpy(to, page->second.data() + inPage, some);
        }
        offset += some;
        to += some;
        size -= some;
    }
}

std::vector<std::pair<std::uint64_t, std::string>> Hdf5Image::pieces(std::uint64_t size) const {
    std::vector<std::pair<std::uint64_t, std::string>> pieces;
    for (const auto& [number, page] : mPages) {
        const std::uint64_t offset = number * kPageBytes;
        if (offset >= size) break;
        pieces.emplace_back(offset, std::string(page.data(), std::min(kPageBytes, size - offset)));
    }
    return pieces;
}

/// Lives on with the library's handle, should that not let go of the file before the process ends.
struct Hdf5Device {
    /// Null once the file is gone, or has failed: the library then writes into the void, so that it can tidy
    /// up.
    Hdf5Storage* storage;
    std::exception_ptr failure; ///< of the storage
    haddr_t allocated;
    haddr_t written;
};

namespace {

std::mutex gLibrary;

/// The functions of the driver. The device reaches open() as the driver's parameter.
struct Driver {
    using Parameter = std::shared_ptr<Hdf5Device>;

    struct Handle : H5FD_t {
        Parameter device;
    };

    static Hdf5Device& of(const H5FD_t* file) { return *static_cast<const Handle*>(file)->device; }

    static void* copyParameter(const void* from) {
        return new (std::nothrow) Parameter(*static_cast<const Parameter*>(from));
    }

    static herr_t freeParameter(void* parameter) {
        delete static_cast<Parameter*>(parameter);
        return 0;
    }

    static H5FD_t* open(const char*, unsigned, hid_t access, haddr_t) {
        auto* handle = new (std::nothrow) Handle();
        if (handle) handle->device = *static_cast<const Parameter*>(H5Pget_driver_info(access));
        return handle;
    }

    static herr_t close(H5FD_t* file) {
        delete static_cast<Handle*>(file);
        return 0;
    }

    static haddr_t allocated(const H5FD_t* file, H5FD_mem_t) { return of(file).allocated; }

    static herr_t allocate(H5FD_t* file, H5FD_mem_t, haddr_t size) {
        of(file).allocated = size;
        return 0;
    }

    static haddr_t written(const H5FD_t* file, H5FD_mem_t) { return of(file).written; }

    /// Nothing may be thrown through the library; and it has no way back from a write that failed.
    template <typename Work>
    static void guarded(Hdf5Device& device, const Work& work) {
        if (!device.storage) return;
        try {
            work(*device.storage);
        } catch (...) {
            device.failure = std::current_exception();
            device.storage = nullptr;
        }
    }

    static herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t size, void* data) {
        std::memset(data, 0, size);
        guarded(of(file), [&](Hdf5Storage& storage) { storage.read(offset, data, size); });
        return 0;
    }

    static herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t size, const void* data) {
        guarded(of(file), [&](Hdf5Storage& storage) { storage.write(offset, data, size); });
        of(file).written = std::max<haddr_t>(of(file).written, offset + size);
        return 0;
    }

    static hid_t add() {
        H5FD_class_t driver = {};
#if H5_VERSION_GE(1, 13, 0)
        driver.version = H5FD_CLASS_VERSION;
        // Any that no other driver takes.
        driver.value = static_cast<H5FD_class_value_t>(H5_VFD_RESERVED + 0x7e7);
#endif
        driver.name = "vdbtet";
        driver.maxaddr = HADDR_MAX;
        driver.fc_degree = H5F_CLOSE_STRONG;
        driver.fapl_size = sizeof(Parameter);
        driver.fapl_copy = copyParameter;
        driver.fapl_free = freeParameter;
        driver.open = open;
        driver.close = close;
        driver.get_eoa = allocated;
        driver.set_eoa = allocate;
        driver.get_eof = written;
        driver.read = read;
        driver.write = write;
        std::fill_n(driver.fl_map, int(H5FD_MEM_NTYPES), H5FD_MEM_DEFAULT);
        return H5FDregister(&driver);
    }
};

hid_t typeOf(NumberType type) {
    switch (type) {
    case NumberType::Float32:
        return H5T_NATIVE_FLOAT;
    case NumberType::Float64:
        return H5T_NATIVE_DOUBLE;
    case NumberType::Int32:
        return H5T_NATIVE_INT32;
    case NumberType::Int64:
        return H5T_NATIVE_INT64;
    case NumberType::UInt8:
        break;
    }
    return H5T_NATIVE_UINT8;
}

/// An object of the library that is let go of at the end of a scope.
struct Object {
    hid_t id;
    herr_t (*close)(hid_t);
    ~Object() {
        if (id >= 0) close(id);
    }
};

} // namespace

/// A turn at the library: the lock, and its habit of printing errors off.
class Hdf5File::Session {
public:
    explicit Session(const Hdf5File& file) : mFile(file), mLock(gLibrary) {
        // Of the interface of version 1.6, should the program use that, let it be.
        H5Eauto_is_v2(H5E_DEFAULT, &mIsV2);
        if (!mIsV2) return;
        H5Eget_auto2(H5E_DEFAULT, &mPrint, &mPrintData);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Session() {
        H5Eclear2(H5E_DEFAULT);
        if (mIsV2) H5Eset_auto2(H5E_DEFAULT, mPrint, mPrintData);
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// @return the result of a call of the library
    template <typename Result>
    Result check(Result result) const {
        if (mFile.mDevice->failure) std::rethrow_exception(mFile.mDevice->failure);
        if (result < 0) fail();
        return result;
    }

    [[noreturn]] void fail() const {
        std::string why = "unknown error";
        // The innermost comes first.
        H5Ewalk2(
            H5E_DEFAULT, H5E_WALK_UPWARD,
            [](unsigned n, const H5E_error2_t* error, void* text) {
                if (n == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
                return herr_t(0);
            },
            &why);
        throw FileError("cannot write " + mFile.mPath + ": HDF5: " + why);
    }

private:
    const Hdf5File& mFile;
    std::lock_guard<std::mutex> mLock;
    unsigned mIsV2 = 0;
    H5E_auto2_t mPrint = nullptr;
    void* mPrintData = nullptr;
};

Hdf5File::Hdf5File(Hdf5Storage& storage, const std::string& path)
    : mPath(path), mDevice(std::make_shared<Hdf5Device>(Hdf5Device{&storage, nullptr, 0, 0})) {
    const Session session(*this);
    const Object access{session.check(H5Pcreate(H5P_FILE_ACCESS)), H5Pclose};
    Object driver{session.check(Driver::add()), H5FDunregister};
    session.check(H5Pset_driver(access.id, driver.id, &mDevice));
    session.check(H5Pset_fclose_degree(access.id, H5F_CLOSE_STRONG));
    session.check(H5Pset_libver_bounds(access.id, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST));
    mFile = session.check(H5Fcreate("vdbtet", H5F_ACC_TRUNC, H5P_DEFAULT, access.id));
    mDriver = driver.id;
    driver.id = -1;
}

Hdf5File::~Hdf5File() {
    if (mFile < 0) return;
    const Session session(*this);
    mDevice->storage = nullptr;
    letGo();
}

bool Hdf5File::letGo() {
    const bool closed = H5Fclose(mFile) >= 0;
    mFile = -1;
    // Not before: the library looks at the driver once more after it has let go of it with its last file.
    if (closed) H5FDunregister(mDriver);
    return closed;
}

Hdf5File::Id Hdf5File::addGroup(const std::string& name, Id parent) {
    const Session session(*this);
    return session.check(
        H5Gcreate2(parent == 0 ? mFile : parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

void Hdf5File::addAttribute(Id group, const std::string& name, const std::string& value) {
    const Session session(*this);
    const Object type{session.check(H5Tcopy(H5T_C_S1)), H5Tclose};
    session.check(H5Tset_size(type.id, value.size()));
    session.check(H5Tset_strpad(type.id, H5T_STR_NULLPAD));
    const Object space{session.check(H5Screate(H5S_SCALAR)), H5Sclose};
    const Object attribute{
        session.check(H5Acreate2(group, name.c_str(), type.id, space.id, H5P_DEFAULT, H5P_DEFAULT)),
        H5Aclose};
    session.check(H5Awrite(attribute.id, type.id, value.data()));
}

void Hdf5File::addAttribute(Id group, const std::string& name, const std::vector<std::int64_t>& values) {
    const Session session(*this);
    const hsize_t count = values.size();
    const Object space{session.check(H5Screate_simple(1, &count, nullptr)), H5Sclose};
    const Object attribute{
        session.check(H5Acreate2(group, name.c_str(), H5T_NATIVE_INT64, space.id, H5P_DEFAULT, H5P_DEFAULT)),
        H5Aclose};
    session.check(H5Awrite(attribute.id, H5T_NATIVE_INT64, values.data()));
}

void Hdf5File::addNumber(Id group, const std::string& name, std::int64_t value) {
    const Id array = addArray(group, {name, NumberType::Int64, {1}});
    const Session session(*this);
    session.check(H5Dwrite(array, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value));
}

Hdf5File::Id Hdf5File::addArray(Id group, const Hdf5Array& array) {
    const Session session(*this);
    const std::vector<hsize_t> extent(array.extent.begin(), array.extent.end());
    const Object space{session.check(H5Screate_simple(int(extent.size()), extent.data(), nullptr)), H5Sclose};
    const Object creation{session.check(H5Pcreate(H5P_DATASET_CREATE)), H5Pclose};
    session.check(H5Pset_obj_track_times(creation.id, false));
    session.check(H5Pset_fill_time(creation.id, H5D_FILL_TIME_NEVER));
    if (array.chunkRows == 0) {
        session.check(H5Pset_alloc_time(creation.id, H5D_ALLOC_TIME_EARLY));
    } else {
        std::vector<hsize_t> chunk = extent;
        chunk[0] = array.chunkRows;
        session.check(H5Pset_chunk(creation.id, int(chunk.size()), chunk.data()));
        if (array.shuffled) session.check(H5Pset_shuffle(creation.id));
        session.check(H5Pset_deflate(creation.id, 6)); // of the level readers know nothing
    }
    const Object links{session.check(H5Pcreate(H5P_LINK_CREATE)), H5Pclose};
    session.check(H5Pset_char_encoding(links.id, H5T_CSET_UTF8));
    return session.check(H5Dcreate2(group, array.name.c_str(), typeOf(array.type), space.id, links.id,
                                    creation.id, H5P_DEFAULT));
}

std::uint64_t Hdf5File::offsetOf(Id array, const Hdf5Array& shape) {
    for (const std::uint64_t length : shape.extent) {
        if (length == 0) return 0;
    }
    const Session session(*this);
    const haddr_t offset = H5Dget_offset(array);
    if (offset == HADDR_UNDEF) session.fail();
    return offset;
}

void Hdf5File::writeChunk(Id array, const Hdf5Array& shape, std::uint64_t firstRow, const void* data,
                          std::size_t size) {
    const Session session(*this);
    std::vector<hsize_t> offset(shape.extent.size(), 0);
    offset[0] = firstRow;
    session.check(H5Dwrite_chunk(array, H5P_DEFAULT, 0, offset.data(), size, data));
}

std::uint64_t Hdf5File::close() {
    const Session session(*this);
    const bool closed = letGo();
    mDevice->storage = nullptr;
    session.check(closed ? 0 : -1);
    return mDevice->allocated;
}

} // namespace vdbtet
