// A picture over the view of rviz, and the legends that are shown there.
#pragma once

#include <QImage>
#include <string>
#include <vector>

#include "haptex/nodes/rviz_plugin/colour_scale.h"

namespace Ogre {
class Overlay;
class PanelOverlayElement;
}  // namespace Ogre

namespace haptex::nodes {

/// A vertical bar of the colours with its ticks and its title above.
QImage paintColourBar(const ColourScale& scale);

/// The names of things beside their colours (distinctColour()), the first few of many.
QImage paintNames(const std::string& title, const std::vector<std::string>& names);

/// One line of text.
QImage paintLabel(const std::string& text);

/// In pixels of the view. By the thread of the scene.
class OverlayPicture {
 public:
  OverlayPicture();
  ~OverlayPicture();
  OverlayPicture(const OverlayPicture&) = delete;
  OverlayPicture& operator=(const OverlayPicture&) = delete;

  /// @param left, top pixels, from the corner of the view
  void show(const QImage& picture, int left, int top);
  /// Keeps its distance from the lower edge when the view changes its size.
  /// @param left, bottom pixels, from the lower left corner of the view
  void showAtBottom(const QImage& picture, int left, int bottom);
  void hide();

 private:
  void paint(const QImage& picture);
  void release();

  Ogre::Overlay* overlay_;
  Ogre::PanelOverlayElement* panel_;
  std::string name_;
  QImage shown_;
};

}  // namespace haptex::nodes
