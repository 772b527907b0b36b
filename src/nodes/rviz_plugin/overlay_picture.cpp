#include "haptex/nodes/rviz_plugin/overlay_picture.h"

#include <OGRE/OgreHardwarePixelBuffer.h>
#include <OGRE/OgreMaterialManager.h>
#include <OGRE/OgreTechnique.h>
#include <OGRE/OgreTextureManager.h>
#include <OGRE/Overlay/OgreOverlay.h>
#include <OGRE/Overlay/OgreOverlayManager.h>
#include <OGRE/Overlay/OgrePanelOverlayElement.h>

#include <QFontMetrics>
#include <QPainter>
#include <algorithm>
#include <atomic>

#include "haptex/nodes/markers/colour_map.h"

namespace haptex::nodes {
namespace {

constexpr char kGroup[] = "General";  // of resources
constexpr int kBarHeight = 180;       // pixels, and so are the others
constexpr int kBarWidth = 18;
constexpr int kMargin = 8;
constexpr int kTextSize = 13;
constexpr std::size_t kMostNames = 12;  // that fit into a view

QFont textFont() {
  QFont font("Sans");
  font.setPixelSize(kTextSize);
  return font;
}

QColor colourOf(const Eigen::Vector3f& colour) {
  return QColor::fromRgbF(colour[0], colour[1], colour[2]);
}

/// A light ground, so that text is read on any scene.
QImage emptyPicture(int width, int height) {
  QImage picture(width, height, QImage::Format_ARGB32);
  picture.fill(QColor(255, 255, 255, 215));
  return picture;
}

int widthOf(const QFontMetrics& metrics, const std::string& text) {
  return metrics.horizontalAdvance(QString::fromStdString(text));
}

}  // namespace

QImage paintColourBar(const ColourScale& scale) {
  const QFontMetrics metrics(textFont());
  const std::vector<ScaleTick> ticks = scale.ticks();
  int text_width = 0;
  for (const ScaleTick& tick : ticks) {
    text_width = std::max(text_width, widthOf(metrics, tick.label));
  }
  const int top = 2 * kMargin + metrics.height() + metrics.height() / 2;
  const int width = std::max(3 * kMargin + kBarWidth + 6 + text_width,
                             2 * kMargin + widthOf(metrics, scale.title));
  QImage picture = emptyPicture(width, top + kBarHeight + kMargin + metrics.height() / 2);
  QPainter painter(&picture);
  painter.setFont(textFont());
  for (int row = 0; row < kBarHeight; ++row) {
    const double fraction = 1.0 - static_cast<double>(row) / (kBarHeight - 1);
    painter.fillRect(kMargin, top + row, kBarWidth, 1, colourOf(viridis(fraction)));
  }
  painter.setPen(Qt::black);
  painter.drawText(kMargin, kMargin + metrics.ascent(), QString::fromStdString(scale.title));
  for (const ScaleTick& tick : ticks) {
    const int y = top + static_cast<int>((1.0 - tick.fraction) * (kBarHeight - 1));
    painter.drawLine(kMargin + kBarWidth, y, kMargin + kBarWidth + 5, y);
    painter.drawText(2 * kMargin + kBarWidth + 2, y + metrics.ascent() / 2 - 1,
                     QString::fromStdString(tick.label));
  }
  return picture;
}

QImage paintNames(const std::string& title, const std::vector<std::string>& names) {
  const QFontMetrics metrics(textFont());
  std::vector<std::string> lines(names.begin(), names.begin() + std::min(names.size(), kMostNames));
  const std::size_t coloured = lines.size();
  if (names.size() > coloured) {
    lines.push_back("and " + std::to_string(names.size() - coloured) + " more");
  }
  int width = widthOf(metrics, title);
  for (const std::string& line : lines) {
    width = std::max(width, kTextSize + kMargin + widthOf(metrics, line));
  }
  const int step = metrics.height() + 3;
  QImage picture =
      emptyPicture(width + 2 * kMargin, 2 * kMargin + step * (static_cast<int>(lines.size()) + 1));
  QPainter painter(&picture);
  painter.setFont(textFont());
  painter.setPen(Qt::black);
  painter.drawText(kMargin, kMargin + metrics.ascent(), QString::fromStdString(title));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int y = kMargin + step * (static_cast<int>(i) + 1);
    if (i < coloured) {
      painter.fillRect(kMargin, y + 2, kTextSize, kTextSize,
                       colourOf(distinctColour(static_cast<int>(i))));
    }
    painter.drawText(2 * kMargin + kTextSize, y + metrics.ascent(),
                     QString::fromStdString(lines[i]));
  }
  return picture;
}

QImage paintLabel(const std::string& text) {
  const QFontMetrics metrics(textFont());
  QImage picture = emptyPicture(widthOf(metrics, text) + kMargin, metrics.height() + 2);
  QPainter painter(&picture);
  painter.setFont(textFont());
  painter.setPen(Qt::black);
  painter.drawText(kMargin / 2, 1 + metrics.ascent(), QString::fromStdString(text));
  return picture;
}

OverlayPicture::OverlayPicture() {
  static std::atomic<unsigned> count{0};
  name_ = "haptex overlay " + std::to_string(count++);
  auto& manager = Ogre::OverlayManager::getSingleton();
  overlay_ = manager.create(name_);
  panel_ = static_cast<Ogre::PanelOverlayElement*>(
      manager.createOverlayElement("Panel", name_ + " panel"));
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  const Ogre::MaterialPtr material =
      Ogre::MaterialManager::getSingleton().create(name_ + " material", kGroup);
  material->getTechnique(0)->setLightingEnabled(false);
  material->getTechnique(0)->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  material->getTechnique(0)->setDepthCheckEnabled(false);
  material->getTechnique(0)->setDepthWriteEnabled(false);
  panel_->setMaterialName(material->getName(), kGroup);
  overlay_->add2D(panel_);
  overlay_->hide();
}

OverlayPicture::~OverlayPicture() {
  auto& manager = Ogre::OverlayManager::getSingleton();
  overlay_->hide();
  overlay_->remove2D(panel_);
  manager.destroyOverlayElement(panel_);
  manager.destroy(overlay_);
  Ogre::MaterialManager::getSingleton().remove(name_ + " material", kGroup);
  release();
}

void OverlayPicture::release() {
  auto& textures = Ogre::TextureManager::getSingleton();
  const std::string texture = name_ + " texture";
  if (textures.resourceExists(texture, kGroup)) textures.remove(texture, kGroup);
}

void OverlayPicture::paint(const QImage& picture) {
  if (picture != shown_) {
    shown_ = picture;
    Ogre::Pass* pass = Ogre::MaterialManager::getSingleton()
                           .getByName(name_ + " material", kGroup)
                           ->getTechnique(0)
                           ->getPass(0);
    pass->removeAllTextureUnitStates();
    release();
    const QImage pixels = picture.convertToFormat(QImage::Format_ARGB32);
    Ogre::DataStreamPtr bytes = std::make_shared<Ogre::MemoryDataStream>(
        const_cast<uchar*>(pixels.constBits()), static_cast<std::size_t>(pixels.sizeInBytes()),
        false, true);
    const Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().loadRawData(
        name_ + " texture", kGroup, bytes, static_cast<Ogre::ushort>(pixels.width()),
        static_cast<Ogre::ushort>(pixels.height()), Ogre::PF_A8R8G8B8, Ogre::TEX_TYPE_2D, 0);
    pass->createTextureUnitState(texture->getName())->setTextureFiltering(Ogre::TFO_NONE);
    panel_->setDimensions(static_cast<float>(pixels.width()), static_cast<float>(pixels.height()));
  }
}

void OverlayPicture::show(const QImage& picture, int left, int top) {
  paint(picture);
  panel_->setVerticalAlignment(Ogre::GVA_TOP);
  panel_->setPosition(static_cast<float>(left), static_cast<float>(top));
  overlay_->show();
}

void OverlayPicture::showAtBottom(const QImage& picture, int left, int bottom) {
  paint(picture);
  panel_->setVerticalAlignment(Ogre::GVA_BOTTOM);
  panel_->setPosition(static_cast<float>(left), static_cast<float>(-bottom - picture.height()));
  overlay_->show();
}

void OverlayPicture::hide() { overlay_->hide(); }

}  // namespace haptex::nodes
