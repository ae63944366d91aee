// SPDX-License-Identifier: Apache-2.0
// OpenCV's library for picture files, loaded at the first picture. Debian's brings GDAL and 115 libraries more, for
// which every program would take 0.1 s at its start. These are the functions that the programs call; another one is an
// error of the linker until it is added.
#include <dlfcn.h>

#include <opencv2/imgcodecs.hpp>

namespace {

void* library() {
  static void* const handle = dlopen(CAIRN_IMGCODECS, RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) CV_Error(cv::Error::StsNotImplemented, dlerror());
  return handle;
}

/// `like` says the type, `name` is what the compiler makes of it and of the function's name.
template <class Function>
Function* loaded(Function* /*like*/, const char* name) {
  void* const found = dlsym(library(), name);
  if (found == nullptr) CV_Error(cv::Error::StsNotImplemented, dlerror());
  return reinterpret_cast<Function*>(found);
}

}  // namespace

namespace cv {

using Decode = Mat(InputArray, int);
using DecodeInto = Mat(InputArray, int, Mat*);

Mat imdecode(InputArray bytes, int flags) {
  static Decode* const call = loaded<Decode>(&imdecode, "_ZN2cv8imdecodeERKNS_11_InputArrayEi");
  return call(bytes, flags);
}

Mat imdecode(InputArray bytes, int flags, Mat* into) {
  static DecodeInto* const call = loaded<DecodeInto>(&imdecode, "_ZN2cv8imdecodeERKNS_11_InputArrayEiPNS_3MatE");
  return call(bytes, flags, into);
}

bool imencode(const String& ending, InputArray picture, std::vector<uchar>& bytes, const std::vector<int>& options) {
  static auto* const call = loaded(
      &imencode,
      "_ZN2cv8imencodeERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_InputArrayERSt6vectorIhSaIhEE"
      "RKSB_IiSaIiEE");
  return call(ending, picture, bytes, options);
}

Mat imread(const String& file, int flags) {
  static auto* const call = loaded(&imread, "_ZN2cv6imreadERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEi");
  return call(file, flags);
}

bool haveImageWriter(const String& file) {
  static auto* const call =
      loaded(&haveImageWriter, "_ZN2cv15haveImageWriterERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEE");
  return call(file);
}

}  // namespace cv
