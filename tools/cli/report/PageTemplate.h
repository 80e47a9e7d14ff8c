/// @file PageTemplate.h
/// The page without its data, made by EmbedPage.cmake from the files in web/.
#pragma once

/// Empty where there was no three.js to put into it.
extern const char* const kPageTemplate;
