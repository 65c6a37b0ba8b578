// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// What a compressed stream of known size becomes. hasHeader: of zlib; otherwise the stream alone.
/// Throws FileError unless it has this size, before memory is taken if no stream can have it.
Bytes Inflate(const std::uint8_t* data, std::size_t size, std::uint64_t expected, bool hasHeader);

/// The content of a file in the format of gzip.
Bytes InflateGzip(Content content);

/// The bytes of text in base 64, with white space and parts with ends of their own, at most `limit`.
/// The characters that were read are taken away from the text.
Bytes DecodeBase64(std::string_view& text, std::size_t limit);

std::string EncodeBase64(const std::uint8_t* data, std::size_t size);

} // namespace SurfaceDiffusion::Files
